// SPDX-License-Identifier: Apache-2.0
// The triple products of a viewing ray with two vertices each, and their changes from pixel to pixel.
//
//           a
//          /.\           The ray d from the eye meets the triangle a b c at weights in the ratio of
//         / d \          d . (b x c)  :  d . (c x a)  :  d . (a x b)
//        b-----c
//
// These are six times the volumes that the ray spans with the sides. In perspective d changes from pixel to pixel, and
// the sides do not; in parallel projection the start of the ray changes.
#include "view/ray_volumes.h"

namespace frontmost {
namespace {

RayVolumes perspective_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& c,
                               const glm::dvec3& direction) {
  RayVolumes v{};
  for (int k = 0; k < 3; ++k) {
    // The triple product of the ray and the two other vertices, in which only the ray depends on the screen.
    const glm::dvec3 side = glm::cross(c[std::size_t((k + 1) % 3)], c[std::size_t((k + 2) % 3)]);
    v.value[k] = glm::dot(side, direction);
    v.step_x[k] = glm::dot(side, rays.step_x());
    v.step_y[k] = glm::dot(side, rays.step_y());
  }
  return v;
}

RayVolumes parallel_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& c, const glm::dvec3& start) {
  RayVolumes v{};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = c[std::size_t((k + 1) % 3)], &q = c[std::size_t((k + 2) % 3)];
    v.value[k] = glm::dot(glm::cross(p - start, q - start), rays.forward());
    // The start of the ray moves: the product changes by the area that the start sweeps along the side from p to q.
    const glm::dvec3 per_shift = glm::cross(rays.forward(), q - p);
    v.step_x[k] = glm::dot(per_shift, rays.step_x());
    v.step_y[k] = glm::dot(per_shift, rays.step_y());
  }
  return v;
}

}  // namespace

RayVolumes ray_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& corners, double x, double y) {
  const glm::dvec3 ray = rays.at(x, y);
  return rays.is_parallel() ? parallel_volumes(rays, corners, ray) : perspective_volumes(rays, corners, ray);
}

}  // namespace frontmost
