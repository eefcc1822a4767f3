// SPDX-License-Identifier: Apache-2.0
#include "raycast/exact_sign.h"

#include <cmath>

#include "base/exact_vector.h"

namespace frontmost::raycast_detail {
namespace {

/// The sums themselves, as numbers that are never rounded.
ExactVector unrounded(const HighLowVector& v) {
  ExactVector sums;
  for (std::size_t axis = 0; axis < 3; ++axis) sums[axis] = Expansion(v.low[axis]) + Expansion(v.high[axis]);
  return sums;
}

}  // namespace

HighLowVector high_low(const glm::vec3& v) { return {{v.x, v.y, v.z}, {}}; }

HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a) {
  HighLowVector d;
  for (int i = 0; i < 3; ++i) {
    const double to = b[i], from = a[i], difference = to - from, from_to = difference - to;
    d.high[std::size_t(i)] = difference;
    d.low[std::size_t(i)] = (to - (difference - from_to)) - (from + from_to);
  }
  return d;
}

int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c) {
  const std::array<double, 3>&x = a.high, &y = b.high, &z = c.high;
  double det = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t j = std::size_t(i + 1) % 3, k = std::size_t(i + 2) % 3;
    const double p = y[j] * z[k], q = y[k] * z[j];
    det += x[std::size_t(i)] * (p - q);
    size += std::abs(x[std::size_t(i)]) * (std::abs(p) + std::abs(q));
  }
  // Three roundings of the coordinates and five on the way: less than 16 half units in the last place of the size.
  if (std::abs(det) > size * 0x1p-49) return det > 0 ? 1 : -1;
  return dot(unrounded(a), cross(unrounded(b), unrounded(c))).sign();
}

}  // namespace frontmost::raycast_detail
