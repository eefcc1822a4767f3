// SPDX-License-Identifier: Apache-2.0
// Where the zero of a scene should lie: at the file's zero, or among points so far from it that floats round details.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// Finds an origin for points whose coordinates are known in doubles: a file's points, as a reader meets them, or
/// vertices that a transform places. The origin is zero, and changes nothing, unless on one axis all points are far
/// from zero: farther than four times their extent and 1024 units, or than 128 times their extent. The extent is that
/// of all points along the axis on which they extend farthest.
///
/// On axes on which the points are four extents from zero, the origin is the roundest number near them: a multiple of
/// the greatest possible power of ten (below one: of two). So models that were moved by a round number are put back
/// where they were, to the bit. "Near" means within four extents, and within a quarter of the way to zero. So
/// subtracting the origin from a float leaves a float, without rounding (Sterbenz), and no point is more than five
/// extents from the origin.
class OriginSearch {
 public:
  /// Adds a point, in any order. Ignores points that are not finite, or not within the range of floats.
  void include(const glm::dvec3& point) {
    // The first few points decide most models.
    if (!is_home_) include_far(point);
  }
  /// True if the origin is zero whatever points follow.
  [[nodiscard]] bool is_home() const { return is_home_; }
  [[nodiscard]] glm::dvec3 origin() const;

 private:
  void include_far(const glm::dvec3& point);
  /// Distance from zero to the nearest point of the bounds.
  [[nodiscard]] double distance(int axis) const;
  [[nodiscard]] double extent() const;

  glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
  bool is_home_ = false;
};

}  // namespace frontmost
