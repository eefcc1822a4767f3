// SPDX-License-Identifier: Apache-2.0
// A sphere in its place, which makes it an ellipsoid.
#pragma once

#include <optional>

#include "frontmost/scene.h"
#include "raycast/curved/box_tree.h"
#include "raycast/curved/double_ray.h"

namespace frontmost::raycast_detail {

struct PlacedSphere {
  glm::dmat3 unit_from_world;  ///< after moving the centre to the origin
  glm::dvec3 centre, reach;    ///< in world space: the middle and half the sides of the box around it
  PrimitiveId id = no_primitive;

  [[nodiscard]] DoubleBox bounds() const;
};

/// None where nothing can be met: no positive radius, a singular transform, sizes and places that are not finite or
/// beyond 2^250 or its inverse.
[[nodiscard]] std::optional<PlacedSphere> place(const Sphere& sphere, const glm::dmat4& world_from_mesh,
                                                PrimitiveId id);

/// The nearest point of the sphere that the ray sees.
[[nodiscard]] std::optional<RayMeeting> meet(const PlacedSphere& sphere, const DoubleRay& ray);

}  // namespace frontmost::raycast_detail
