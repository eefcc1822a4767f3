// SPDX-License-Identifier: Apache-2.0
// The three areas of a polygon on the screen: in the picture, in the scene, and as a solid angle from the eye.
//
// A place (x, y) of the picture has the direction (u, v, 1) in eye space; u and v are affine in x and y. A surface
// point with key 1 / distance lies at (u, v, 1) / key; in parallel projection at (u, v, -key), with key -distance.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

#include "frontmost/view.h"

namespace frontmost::faces_detail {

/// A place in the picture, in pixels, and the key of the surface there: affine over the screen, greater for nearer.
struct ScreenPoint {
  double x, y, key;
};

struct Range {
  double low, high;
};

[[nodiscard]] inline Range range_of(double a, double b, double c) { return {std::min({a, b, c}), std::max({a, b, c})}; }

struct Areas {
  double pixels = 0, units = 0, solid_angle = 0;

  Areas& operator+=(const Areas& other) {
    pixels += other.pixels;
    units += other.units;
    solid_angle += other.solid_angle;
    return *this;
  }
};

/// Computes areas for a view.
class AreaRule {
 public:
  explicit AreaRule(const View& view);

  /// The areas of a convex polygon in one plane, wound either way. Precondition: at least three corners; keys above 0
  /// in perspective.
  [[nodiscard]] Areas areas_of(std::span<const ScreenPoint> polygon) const;

 private:
  [[nodiscard]] glm::dvec3 direction_to(const ScreenPoint& p) const {
    return {left_ + p.x * step_x_, top_ - p.y * step_y_, 1};
  }
  [[nodiscard]] glm::dvec3 place_of(const glm::dvec3& direction, double key) const {
    return orthographic_ ? glm::dvec3(direction.x, direction.y, -key) : direction / key;
  }

  bool orthographic_;
  double left_, top_, step_x_, step_y_;
};

/// The angle of the point (x, y) from the x axis, for y >= 0. Uses only square roots and a series, so it is the same on
/// every machine, up to a few units in the last place.
[[nodiscard]] double angle_of(double x, double y);

}  // namespace frontmost::faces_detail
