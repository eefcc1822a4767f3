// SPDX-License-Identifier: Apache-2.0
// The sign of the determinant a.x b.y - a.y b.x + b.x c.y - b.y c.x + c.x a.y - c.y a.x. The usual form, a product of
// differences, rounds if the differences do. This form does not round at all: a product of two floats has at most 48
// bits and fits a double, from the smallest subnormal squared (2^-298) to the greatest float squared (2^256).
// Expansions then add the six doubles without error.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#include "base/orientation.h"

namespace frontmost {
namespace {

struct Sum {
  double high, low;
};

/// a + b without error (D. Knuth): high + low, where high is the rounded sum.
Sum two_sum(double a, double b) {
  const double high = a + b, b_part = high - a, a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

/// Adds the terms one by one to a list of numbers that do not overlap, smallest first, whose exact sum is that of the
/// terms: the last number that is not zero decides.
int sign_of_sum(const double (&terms)[6]) {
  double parts[6];
  int count = 0;
  for (const double term : terms) {
    double carry = term;
    for (int i = 0; i < count; ++i) {
      const Sum sum = two_sum(carry, parts[i]);
      parts[i] = sum.low;
      carry = sum.high;
    }
    parts[count++] = carry;
  }
  for (int i = count; i-- > 0;)
    if (parts[i] != 0) return parts[i] > 0 ? 1 : -1;
  return 0;
}

}  // namespace

int detail::exact_orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const double ax = a.x, ay = a.y, bx = b.x, by = b.y, cx = c.x, cy = c.y;
  return sign_of_sum({ax * by, -(ay * bx), bx * cy, -(by * cx), cx * ay, -(cy * ax)});
}

}  // namespace frontmost
