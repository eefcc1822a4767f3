// SPDX-License-Identifier: Apache-2.0
// Which way three points turn, exactly.
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
