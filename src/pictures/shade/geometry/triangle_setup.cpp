// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry/triangle_setup.h"

#include <cmath>

namespace frontmost::shading {
namespace {

/// \returns false if a value is not finite.
bool store(const RayVolumes& v, double scale, std::array<Affine, 3>& weight) {
  bool finite = true;
  for (int k = 0; k < 3; ++k) {
    const Affine a{float(v.value[k] * scale), float(v.step_x[k] * scale), float(v.step_y[k] * scale)};
    finite = finite && std::isfinite(a.at_reference) && std::isfinite(a.step_x) && std::isfinite(a.step_y);
    weight[std::size_t(k)] = a;
  }
  return finite;
}

glm::vec3 unit_or(const glm::dvec3& v, const glm::dvec3& fallback) {
  const double length = std::sqrt(glm::dot(v, v));
  return glm::vec3(length > 1e-300 ? v / length : fallback);
}

}  // namespace

void set_up_plane(TriangleSetup& setup, const ScreenRays& rays, const std::array<glm::vec3, 3>& corners_world,
                  const glm::vec2& reference) {
  setup.corner_world = corners_world;
  std::array<glm::dvec3, 3> c;
  for (std::size_t k = 0; k < 3; ++k) {
    c[k] = glm::dvec3(corners_world[k]) - rays.eye();
    setup.corner[k] = glm::vec3(c[k]);
  }
  setup.reference = reference;
  const RayVolumes v = ray_volumes(rays, c, double(reference.x), double(reference.y));
  const double sum = v.value.x + v.value.y + v.value.z;
  const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double away = glm::dot(normal, rays.is_parallel() ? rays.forward() : c[0]);
  setup.is_backside = away > 0;
  setup.plane_normal = unit_or(away > 0 ? -normal : normal, -rays.forward());
  // At the reference, inside the triangle, the sum has the sign of `away`, so the quotients are positive.
  const bool valid = sum * away > 0 && store(v, 1 / sum, setup.weight);
  if (!valid) setup.weight.fill(Affine{1.0f / 3, 0, 0});
}

}  // namespace frontmost::shading
