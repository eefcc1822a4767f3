// SPDX-License-Identifier: Apache-2.0
// Cuts the polygons of a file into triangles: always corner count - 2 of them, the same ones on every machine.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "io/models/polygons/corner_tree.h"

namespace frontmost {

/// Triangulates polygons. Keeps its arrays from polygon to polygon, and counts the work of all of them, so that hostile
/// files cannot make it slow: see may_work().
class Triangulator {
 public:
  /// Returns triangles as indices of `corners`, in the polygon's winding. Correct for each simple polygon, convex or
  /// not, flat or nearly flat, and for outlines that touch themselves without crossing: at corners, along bridges to
  /// holes and islands, at spikes. Zero-area triangles appear only where corners coincide or are collinear. Polygons
  /// that cross themselves are covered somehow; small ones have the least area of wrong winding. Polygons without a
  /// direction (all corners collinear, or not finite), and the rest of one that takes too long, become fans. The result
  /// is valid until the next call. Precondition: at least 3 corners.
  std::span<const glm::uvec3> operator()(std::span<const glm::vec3> corners);

 private:
  void project(std::span<const glm::vec3> corners);
  bool fan_is_right() const;
  void fan(std::size_t first_remaining);
  void clip_ears();
  enum class Ear : std::uint8_t { clear, flat, touched, any };
  bool is_ear(std::uint32_t corner, Ear kind);
  bool is_blocked(std::uint32_t corner, bool by_touching);
  bool is_spike(std::uint32_t corner) const;
  double wrong_area(const glm::uvec3& triangle) const;
  void try_all();
  void clip(std::uint32_t corner);
  int turn(std::uint32_t corner) const;
  void note_turn(std::uint32_t corner);
  bool may_work() const { return work_ < allowed_work_; }

  std::vector<glm::vec2> points_;               ///< counter-clockwise, exact copies of two coordinates
  std::vector<std::uint32_t> previous_, next_;  ///< rings of the remaining corners
  CornerTree blockers_;                         ///< marks corners that do not turn left: only they can block an ear
  std::vector<bool> is_left_;
  /// The best cut for the corners from begin to end: a triangle whose third corner is `tip`.
  struct Cut {
    double wrong = 0;  ///< the area of wrong winding
    std::uint32_t tip = 0;
  };
  std::vector<Cut> cuts_;  ///< at begin * count + end
  std::vector<glm::uvec3> triangles_;
  std::uint64_t work_ = 0, allowed_work_ = 1 << 25;  ///< counted in boxes and corners tested against ears
  bool is_flat_ = true;                              ///< whether the polygon has a direction to be seen from
};

}  // namespace frontmost
