// SPDX-License-Identifier: Apache-2.0
// Three points are collinear when their shadows on all three coordinate planes are: when the determinants
//   a.x b.y - a.y b.x + b.x c.y - b.y c.x + c.x a.y - c.y a.x
// and its two fellows are zero. The usual form, a product of differences, rounds when the differences do. This one
// does not round at all: a product of two floats has at most 48 bits and fits a double, from the smallest subnormal
// squared (2^-298) to the greatest float squared (2^256). Only the sum of six doubles is left, and Shewchuk's
// expansions add them without error.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#include "report/collinear.h"

#include <array>
#include <cmath>

namespace frontmost {
namespace {

using Terms = std::array<double, 6>;

// Adds one term after the other to a list of numbers that do not overlap, whose exact sum is that of the terms. Such
// a list sums to zero only if every number in it is zero.
bool sum_is_zero(const Terms& terms) {
  Terms parts{};
  for (std::size_t count = 0; count < terms.size(); ++count) {
    double carry = terms[count];
    for (std::size_t i = 0; i < count; ++i) {
      const double sum = carry + parts[i], part_of_sum = sum - carry;
      parts[i] = (carry - (sum - part_of_sum)) + (parts[i] - part_of_sum);
      carry = sum;
    }
    parts[count] = carry;
  }
  for (const double part : parts)
    if (part != 0) return false;
  return true;
}

bool shadow_is_flat(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const Terms terms{a.x * b.y, -a.y * b.x, b.x * c.y, -b.y * c.x, c.x * a.y, -c.y * a.x};
  double sum = 0, magnitude = 0;
  for (const double term : terms) {
    sum += term;
    magnitude += std::abs(term);
  }
  // Five additions err by less than 5 * 2^-53 * magnitude; almost every triangle is decided here.
  if (std::abs(sum) > 1e-15 * magnitude) return false;
  return sum_is_zero(terms);
}

}  // namespace

bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 p(a), q(b), r(c);
  return shadow_is_flat({p.x, p.y}, {q.x, q.y}, {r.x, r.y}) && shadow_is_flat({p.y, p.z}, {q.y, q.z}, {r.y, r.z}) &&
         shadow_is_flat({p.z, p.x}, {q.z, q.x}, {r.z, r.x});
}

}  // namespace frontmost
