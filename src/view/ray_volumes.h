// SPDX-License-Identifier: Apache-2.0
// Where on a triangle a viewing ray meets its plane.
//
// The barycentric weights of that point are, up to a common factor, the volumes that the ray spans with two corners
// each: triple products that are affine in the screen position. They stay valid for triangles that cross the eye plane,
// and their ratios are perspective-correct without ever dividing by a depth of 0.
#pragma once

#include <array>

#include "view/screen_rays.h"

namespace frontmost {

/// Of each corner the volume without it, at some screen position, and its change from there per pixel.
struct RayVolumes {
  glm::dvec3 value, step_x, step_y;
};

/// At screen position (x, y), in pixels, of a triangle whose corners are given in world axes from the eye.
[[nodiscard]] RayVolumes ray_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& corners, double x,
                                     double y);

}  // namespace frontmost
