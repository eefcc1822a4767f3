// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry/triangle_setup.h"

#include <cmath>

namespace frontmost::shading {
namespace {

/// Twice the volume spanned with the ray, for each corner left out in turn, and its change over the screen.
struct Volumes {
  glm::dvec3 at_reference, step_x, step_y;
};

Volumes perspective_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& c, const glm::dvec3& direction) {
  Volumes v{};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 side = glm::cross(c[std::size_t((k + 1) % 3)], c[std::size_t((k + 2) % 3)]);
    v.at_reference[k] = glm::dot(side, direction);
    v.step_x[k] = glm::dot(side, rays.step_x());
    v.step_y[k] = glm::dot(side, rays.step_y());
  }
  return v;
}

Volumes parallel_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& c, const glm::dvec3& start) {
  Volumes v{};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = c[std::size_t((k + 1) % 3)], &q = c[std::size_t((k + 2) % 3)];
    v.at_reference[k] = glm::dot(glm::cross(p - start, q - start), rays.forward());
    const glm::dvec3 per_shift = glm::cross(rays.forward(), q - p);
    v.step_x[k] = glm::dot(per_shift, rays.step_x());
    v.step_y[k] = glm::dot(per_shift, rays.step_y());
  }
  return v;
}

/// False when a value is not finite.
bool store(const Volumes& v, double scale, std::array<Affine, 3>& weight) {
  bool finite = true;
  for (int k = 0; k < 3; ++k) {
    const Affine a{float(v.at_reference[k] * scale), float(v.step_x[k] * scale), float(v.step_y[k] * scale)};
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
  const glm::dvec3 ray = rays.at(double(reference.x), double(reference.y));
  const Volumes v = rays.is_parallel() ? parallel_volumes(rays, c, ray) : perspective_volumes(rays, c, ray);
  const double sum = v.at_reference.x + v.at_reference.y + v.at_reference.z;
  const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double away = glm::dot(normal, rays.is_parallel() ? rays.forward() : c[0]);
  setup.is_backside = away > 0;
  setup.plane_normal = unit_or(away > 0 ? -normal : normal, -rays.forward());
  // At the reference, inside the triangle, the sum has the sign of `away`; dividing by it makes the weights positive.
  const bool valid = sum * away > 0 && store(v, 1 / sum, setup.weight);
  if (!valid) setup.weight.fill(Affine{1.0f / 3, 0, 0});
}

}  // namespace frontmost::shading
