// SPDX-License-Identifier: Apache-2.0
// Defines which triangles single rays and segments meet, and which triangles stand between a point and a light. The
// definitions are exact, in plain scalar code. Kernels find the same bits faster, and call these functions if rounding
// leaves a doubt. sample_rule.h holds the definition for rays through the samples of a view.
//
//              c
//             / |         The line from o along d passes through the triangle, edges included, if it turns to the same
//    o ------/--|---> d   side about all three edges: the signs of det(d, b - o, c - o), det(d, c - o, a - o) and
//           a---b         det(d, a - o, b - o) agree. The triangle is ahead of o if the sign of det(a - o, b - o, c -
//           o)
//                         agrees with them. Differences of floats are kept as exact sums of two doubles.
#pragma once

#include <array>

#include "frontmost/raycast.h"

namespace frontmost::raycast_detail {

/// A vector whose coordinates are exact sums of two doubles.
struct HighLowVector {
  std::array<double, 3> high{}, low{};
};

/// high_low(v) returns v itself, and high_low_difference(b, a) returns b - a.
[[nodiscard]] HighLowVector high_low(const glm::vec3& v);
[[nodiscard]] HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a);

/// Sign of the determinant: -1, 0 or 1. Takes a few nanoseconds, or microseconds if the determinant is within rounding
/// of zero. Precondition: the vectors come from finite floats, so that no product leaves the range of doubles.
[[nodiscard]] int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c);

/// A ray, or a segment whose far end is at t = 1.
struct Query {
  glm::vec3 origin, end;  ///< `end` is used for segments only
  glm::vec3 direction;    ///< in segments: end - origin, rounded
  bool is_segment;
  bool is_one_way = false;  ///< one-sided triangles are not met from behind, as in views with Culling::material
};

/// \returns false if nothing can be met: a coordinate is not finite, or there is no direction.
[[nodiscard]] bool is_valid(const Query& query);

/// Returns the hit of the query with one triangle, or none. This is the definition of a hit, on plain scalars: whether
/// the query meets the triangle is decided exactly.
[[nodiscard]] RayHit meet(const Query& query, const std::array<glm::vec3, 3>& corners, PrimitiveId id);

/// Returns false if the point is undefined: a value is not finite, a weight is negative, or no weight is above zero.
[[nodiscard]] bool is_valid(const TrianglePoint& point);

using CornerPositions = std::array<glm::vec3, 3>;

/// Returns whether the vertices are those of the point's own triangle, in any order.
[[nodiscard]] bool is_own(const CornerPositions& corners, const TrianglePoint& point);

/// True if the ray from the point towards the light passes through the triangle. Passing through an edge or vertex
/// counts; passing along the triangle's plane or starting on it does not. A point's own triangle never counts. Takes
/// tens of nanoseconds, or microseconds if the ray is within 1e-14 of touching. Precondition: is_valid(point), finite
/// values elsewhere, and a direction.
[[nodiscard]] bool stands_before(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light);

/// Returns the rounded point where the ray passes through the triangle's plane. Precondition: stands_before() is true.
[[nodiscard]] glm::dvec3 passed_point(const CornerPositions& corners, const TrianglePoint& point,
                                      const glm::vec3& to_light);

/// Returns the rounded position of the point.
[[nodiscard]] glm::dvec3 position_of(const TrianglePoint& point);

}  // namespace frontmost::raycast_detail
