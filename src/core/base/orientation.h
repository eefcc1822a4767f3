// SPDX-License-Identifier: Apache-2.0
// Which way three points turn, exactly.
//
//        c                    +1: c lies to the left of the way from a to b
//       /                      0: c lies on the line through a and b
//      /                      -1: c lies to its right
//     a --------> b
//
// (x to the right, y up: on a screen, where y runs down, the signs are the other way round.) The area of the triangle
// has this sign too, but a float or a double of it rounds, and three points that a file has on one line would turn by
// chance. So a filter in doubles decides where the error bound allows, and exact sums of products decide the rest.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace frontmost {

namespace detail {
/// What rounding leaves open.
[[nodiscard]] int exact_orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c);
}  // namespace detail

/// +1 when a, b, c turn left (counter-clockwise), -1 when they turn right, 0 when they lie on one line. Exact for all
/// finite coordinates.
[[nodiscard]] inline int orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const double ax = a.x, ay = a.y;
  const double plus = (double(b.x) - ax) * (double(c.y) - ay), minus = (double(b.y) - ay) * (double(c.x) - ax);
  const double value = plus - minus;
  // Each product errs by less than 4 * 2^-53 of itself, none can underflow; 1e-15 is 9 * 2^-53. This decides almost
  // all.
  if (std::abs(value) > 1e-15 * (std::abs(plus) + std::abs(minus))) return value > 0 ? 1 : -1;
  return detail::exact_orientation(a, b, c);
}

}  // namespace frontmost
