// SPDX-License-Identifier: Apache-2.0
// What single rays and segments meet, and what stands between a point and a light: the definitions, exact, in plain
// scalar code. Kernels are faster ways to the same bits, and ask here where rounding leaves them in doubt. For rays
// through the samples of a view the definition is in sample_rule.h.
//
//              c
//             / |         The line from o along d passes through the triangle, edges included, where it turns to the
//    o ------/--|---> d   same side about all three edges: the signs of det(d, b - o, c - o), det(d, c - o, a - o) and
//           a---b         det(d, a - o, b - o). The triangle is before o where that of det(a - o, b - o, c - o) is the
//                         same.
//
// Differences of floats are kept as exact sums of two doubles. A determinant is worked out in doubles first, and
// without any rounding where its sign is not certain then.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <array>

#include "frontmost/raycast.h"

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

/// A ray, or a segment whose far end is at t = 1.
struct Query {
  glm::vec3 origin, end;  ///< `end` of segments only
  glm::vec3 direction;    ///< of segments: end - origin, rounded
  bool is_segment;
  bool is_one_way = false;  ///< one-sided triangles are not met from behind, as in views with Culling::material
};

/// \returns false where nothing can be met: a coordinate that is not finite, or no direction.
[[nodiscard]] bool is_valid(const Query& query);

/// A triangle met at its exact place, or not at all: the definition, on plain scalars.
[[nodiscard]] RayHit meet(const Query& query, const std::array<glm::vec3, 3>& corners, PrimitiveId id);

/// False where there is no such point: a value that is not finite, a negative weight, or none above zero.
[[nodiscard]] bool is_valid(const TrianglePoint& point);

using CornerPositions = std::array<glm::vec3, 3>;

/// The triangle's corners are those of the point's own, in any order.
[[nodiscard]] bool is_own(const CornerPositions& corners, const TrianglePoint& point);

/// True when the ray from the point towards the light passes through the triangle: through an edge or corner counts,
/// along its plane or starting on it does not. An own triangle never does.
/// Tens of nanoseconds unless something is within 1e-14 of touching; microseconds then.
/// Precondition: is_valid(point), finite values elsewhere, and a direction.
[[nodiscard]] bool stands_before(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light);

/// Where the ray passes through the triangle's plane, rounded. Precondition: stands_before().
[[nodiscard]] glm::dvec3 passed_point(const CornerPositions& corners, const TrianglePoint& point,
                                      const glm::vec3& to_light);

/// The point itself, rounded.
[[nodiscard]] glm::dvec3 position_of(const TrianglePoint& point);

}  // namespace frontmost::raycast_detail
