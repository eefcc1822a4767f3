// SPDX-License-Identifier: Apache-2.0
// The turn of three points, exactly.
//
//        c                    +1: c lies to the left of the way from a to b
//       /                      0: c lies on the line through a and b
//      /                      -1: c lies to its right
//     a --------> b
//
// (x to the right, y up; on a screen, where y runs down, the signs are reversed.) The area of the triangle has this
// sign too, but its float or double is rounded, and three points on one line would turn at random. So a filter in
// doubles decides if its error bound allows, and exact sums of products decide the rest.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace frontmost {

namespace detail {
/// Decides the cases that rounding leaves open.
[[nodiscard]] int exact_orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c);
}  // namespace detail

/// +1 if a, b, c turn left (counter-clockwise), -1 if right, 0 if on one line. Exact for all finite coordinates.
[[nodiscard]] inline int orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const double ax = a.x, ay = a.y;
  const double plus = (double(b.x) - ax) * (double(c.y) - ay), minus = (double(b.y) - ay) * (double(c.x) - ax);
  const double value = plus - minus;
  // Each product errs by less than 4 * 2^-53 of itself, and none can underflow; 1e-15 is 9 * 2^-53. This test decides
  // almost all cases.
  if (std::abs(value) > 1e-15 * (std::abs(plus) + std::abs(minus))) return value > 0 ? 1 : -1;
  return detail::exact_orientation(a, b, c);
}

/// Whether the area of a triangle in space is exactly zero. Precondition: the floats are finite.
[[nodiscard]] inline bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orientation({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orientation({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

}  // namespace frontmost
