// SPDX-License-Identifier: Apache-2.0
// Why a picture is blank.
#pragma once

#include <frontmost/surfaces.h>
#include <frontmost/visible.h>

#include <array>
#include <mutex>
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
  /// In a clause: "all of the model is behind the camera".
  [[nodiscard]] std::string clause() const;

 private:
  static constexpr std::size_t cause_count = 7;

  View view_;
  std::mutex mutex_;
  std::array<std::uint64_t, cause_count> counts_{};
};

/// What keeps all triangles of a blank picture out of it. O(triangles).
[[nodiscard]] std::string blank_reason(const Surfaces& surfaces, const View& view);

}  // namespace frontmost::cli
