// SPDX-License-Identifier: Apache-2.0
// Cuts the polygons of a file into triangles: always corner count - 2 of them, the same ones on every machine.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "io/models/polygons/corner_tree.h"

namespace frontmost {

/// Keeps its arrays from polygon to polygon, and an account of the work done for all of them, so that hostile files
/// cannot make it slow: see may_work().
class Triangulator {
 public:
  /// Triangles as numbers of `corners`, in the polygon's winding. Right for every simple polygon, convex or not, flat
  /// or nearly so, and for outlines that touch themselves without crossing: at corners, along bridges to holes and
  /// islands, at spikes. Zero-area triangles appear only where corners coincide or lie on one line. Polygons that cross
  /// themselves are covered somehow, the smaller ones with the least area turned the wrong way. Polygons
  /// without a direction (all corners on one line, or not finite), and the rest of one that takes too long, become
  /// fans. The result is valid until the next call. Precondition: at least 3 corners.
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
  std::vector<std::uint32_t> previous_, next_;  ///< rings of the corners that remain
  CornerTree blockers_;                         ///< marks corners that do not turn left: only they can block an ear
  std::vector<bool> is_left_;
  /// How corners begin to end are cut best: with a triangle that has its third corner at `tip`.
  struct Cut {
    double wrong = 0;  ///< the area that turns the wrong way
    std::uint32_t tip = 0;
  };
  std::vector<Cut> cuts_;  ///< at begin * count + end
  std::vector<glm::uvec3> triangles_;
  std::uint64_t work_ = 0, allowed_work_ = 1 << 25;  ///< counted in boxes and corners held against ears
  bool is_flat_ = true;                              ///< the polygon has a direction to be seen from
};

}  // namespace frontmost
