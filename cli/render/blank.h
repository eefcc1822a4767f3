// SPDX-License-Identifier: Apache-2.0
// Whether a picture shows anything: why it is blank, and whether what is in it can be told from its background.
#pragma once

#include <frontmost/image.h>
#include <frontmost/scene.h>
#include <frontmost/sheets.h>
#include <frontmost/streams.h>
#include <frontmost/view.h>

#include <array>
#include <mutex>
#include <optional>
#include <span>
#include <string>

namespace frontmost::cli {

/// True when no sample sees anything.
[[nodiscard]] bool is_blank(const Visible& visible);

/// Counts what keeps triangles out of a view.
class BlankReason {
 public:
  explicit BlankReason(const View& view) : view_(view) {}

  /// Each is charged with the first thing that hides it, in the order in which a renderer would find it.
  /// Safe to call from several threads.
  void add(std::span<const std::array<glm::vec3, 3>> triangles);
  /// Adds on rank 0 what all others have counted. All of them call it.
  void gather(Ranks& ranks);
  /// Whether a triangle is in the frame, but seen at no sample: by its size, or by holes of its material.
  [[nodiscard]] bool has_small() const;
  /// In a clause: "all of the model is behind the camera".
  [[nodiscard]] std::string clause() const;

 private:
  static constexpr std::size_t cause_count = 7;

  View view_;
  std::mutex mutex_;
  std::array<std::uint64_t, cause_count> counts_{};
};

/// What keeps all triangles of a blank picture out of it. O(triangles), and a picture of a copy of the scene if some of
/// them are in the frame and materials have holes.
[[nodiscard]] std::string blank_reason(const Surfaces& surfaces, const View& view, const Execution& execution);

/// A pixel stands out when one of its channels differs from the background's by more than 8 of 255 steps, which is
/// about what an eye can tell on a screen. Nothing stands out where fewer than one in a thousand of the pixels do that
/// see something at their first sample; `primitives` are those samples, or more. O(pixels), but ends at the first
/// thousandth that stands out. False where nothing is seen.
[[nodiscard]] bool nothing_stands_out(const Image& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
[[nodiscard]] bool nothing_stands_out(const Bitmap& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
/// The same of shapes, however large: all of them are like the background.
[[nodiscard]] bool nothing_stands_out(const Figure& figure, const glm::vec3& background);

/// Whether all that is seen is of a material whose opacity is 0. False where nothing is seen.
[[nodiscard]] bool is_invisible(const Surfaces& surfaces, std::span<const PrimitiveId> primitives);

/// The warning for a picture in which nothing stands out.
[[nodiscard]] std::string contrast_warning(bool is_invisible);

}  // namespace frontmost::cli
