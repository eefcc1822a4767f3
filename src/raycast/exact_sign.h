// SPDX-License-Identifier: Apache-2.0
// The exact sign of 3 x 3 determinants of differences of floats.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace frontmost::raycast_detail {

/// A vector whose coordinates are exact sums of two doubles.
struct HighLowVector {
  std::array<double, 3> high{}, low{};
};

/// v itself; b - a.
[[nodiscard]] HighLowVector high_low(const glm::vec3& v);
[[nodiscard]] HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a);

/// -1, 0 or 1. A few nanoseconds unless the determinant is within rounding of zero; a few microseconds then.
/// Precondition: the vectors come from finite floats, so that no product leaves the range of doubles.
[[nodiscard]] int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c);

}  // namespace frontmost::raycast_detail
