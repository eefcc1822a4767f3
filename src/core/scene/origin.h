// SPDX-License-Identifier: Apache-2.0
// Where the zero of a scene should lie: in the file's own, or among points that lie far from it, where floats would
// round what they are made of.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// Finds an origin for points whose coordinates are known in doubles: those of a file, as a reader comes by them, or of
/// vertices that a transform places. It is zero, so that nothing changes, unless on one axis all points are farther
/// from zero than four times their extent and 1024 units, or than 128 times their extent; extent is that of all points
/// along the axis where it is the greatest.
///
/// On axes on which the points are four extents from zero, it is then the roundest number near them: the greatest power
/// of ten (below one: of two) of which a multiple lies so near decides. So models that were moved by a round number are
/// put back where they were, to the bit. "Near" is within four extents, and within a quarter of the way to zero: so
/// what is taken from a float leaves a float, without rounding (Sterbenz), and no point is farther from the origin than
/// five extents.
class OriginSearch {
 public:
  /// In any order. Points that are not finite, or not within the range of floats, count for nothing.
  void include(const glm::dvec3& point) {
    // Most models are settled by their first few points.
    if (!is_home_) include_far(point);
  }
  /// True once no further point can make the origin anything but zero.
  [[nodiscard]] bool is_home() const { return is_home_; }
  [[nodiscard]] glm::dvec3 origin() const;

 private:
  void include_far(const glm::dvec3& point);
  /// From zero to the nearest point of the bounds.
  [[nodiscard]] double distance(int axis) const;
  [[nodiscard]] double extent() const;

  glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
  bool is_home_ = false;
};

}  // namespace frontmost
