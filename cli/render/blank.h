// SPDX-License-Identifier: Apache-2.0
// Checks whether a picture shows anything: why it is blank, or whether its contents stand out from the background.
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

/// Whether no sample sees anything.
[[nodiscard]] bool is_blank(const Visible& visible);

/// Counts the causes that keep triangles out of a view.
class BlankReason {
 public:
  explicit BlankReason(const View& view) : view_(view) {}

  /// Counts each triangle under the first cause that hides it, in the order in which a renderer would find it. May be
  /// called from several threads.
  void add(std::span<const std::array<glm::vec3, 3>> triangles);
  /// Adds the counts of all ranks on rank 0. All ranks call it.
  void gather(Ranks& ranks);
  /// Whether a triangle is in the frame, but covers no sample: because of its size, or of holes in its material.
  [[nodiscard]] bool has_small() const;
  /// Returns the reason as a clause: "all of the model is behind the camera".
  [[nodiscard]] std::string clause() const;

 private:
  static constexpr std::size_t cause_count = 7;

  View view_;
  std::mutex mutex_;
  std::array<std::uint64_t, cause_count> counts_{};
};

/// Returns the reason why a picture is blank, as a clause. O(triangles). If some triangles are in the frame and
/// materials have holes, it also renders a copy of the scene.
[[nodiscard]] std::string blank_reason(const Surfaces& surfaces, const View& view, const Execution& execution);

/// Whether the picture looks empty. A pixel stands out if one of its channels differs from the background's by more
/// than 8 of 255 steps, about the limit of the eye on a screen. The picture looks empty if fewer than one in a thousand
/// of the pixels whose first sample sees something stand out. `primitives` begins with these first samples. O(pixels),
/// but ends when a thousandth stands out. False if nothing is seen.
[[nodiscard]] bool nothing_stands_out(const Image& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
[[nodiscard]] bool nothing_stands_out(const Bitmap& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
/// Whether all shapes look like the background, however large they are.
[[nodiscard]] bool nothing_stands_out(const Figure& figure, const glm::vec3& background);

/// Whether all visible materials have opacity 0. False if nothing is seen.
[[nodiscard]] bool is_invisible(const Surfaces& surfaces, std::span<const PrimitiveId> primitives);

/// Returns the warning about a picture in which nothing stands out.
[[nodiscard]] std::string contrast_warning(bool is_invisible);

}  // namespace frontmost::cli
