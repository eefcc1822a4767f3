// SPDX-License-Identifier: Apache-2.0
// The frame in which rays meet patches: its third axis is the ray.
#pragma once

#include <cmath>

#include "raycast/curved/double_ray.h"
#include "raycast/curved/patch_rules.h"

namespace frontmost::raycast_detail {

struct RayFrame {
  glm::dvec3 along, across_x, across_y;  ///< of unit length, at right angles
  double length;                         ///< of the ray's direction
  double nearest, farthest;              ///< what counts along the ray, in world units

  /// (T. Duff et al. Building an Orthonormal Basis, Revisited. 2017.)
  explicit RayFrame(const DoubleRay& ray)
      : length(std::sqrt(glm::dot(ray.direction, ray.direction))),
        nearest(ray.from * length),
        farthest(ray.to * length * kPastTheEnd) {
    along = ray.direction / length;
    const double sign = std::copysign(1.0, along.z), a = -1 / (sign + along.z), b = along.x * along.y * a;
    across_x = glm::dvec3(1 + sign * along.x * along.x * a, sign * b, -sign * along.x);
    across_y = glm::dvec3(b, sign + along.y * along.y * a, -along.y);
  }
};

}  // namespace frontmost::raycast_detail
