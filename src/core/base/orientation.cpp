// SPDX-License-Identifier: Apache-2.0
// The sign of the determinant a.x b.y - a.y b.x + b.x c.y - b.y c.x + c.x a.y - c.y a.x. The usual form, a product of
// differences, rounds if the differences do. This form does not round at all: a product of two floats has at most 48
// bits and fits a double, from the smallest subnormal squared (2^-298) to the greatest float squared (2^256). An
// expansion then adds the six doubles without error.
#include "base/orientation.h"

#include "base/exact_vector.h"

namespace frontmost {

int detail::exact_orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const double ax = a.x, ay = a.y, bx = b.x, by = b.y, cx = c.x, cy = c.y;
  return Expansion::sum({ax * by, -(ay * bx), bx * cy, -(by * cx), cx * ay, -(cy * ax)}).sign();
}

}  // namespace frontmost
