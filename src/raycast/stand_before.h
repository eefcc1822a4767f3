// SPDX-License-Identifier: Apache-2.0
// Whether a triangle stands between a point of a surface and a light: the definition, exact.
#pragma once

#include <array>

#include "frontmost/raycast.h"

namespace frontmost::raycast_detail {

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
