// SPDX-License-Identifier: Apache-2.0
// The shadow map of a light for a visible picture, as pictures use it.
#pragma once

#include "frontmost/zbuffer.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::test {

/// `to_light` is a unit vector; the map borrows `planes`.
[[nodiscard]] inline shading::ShadowMap light_map(const Surfaces& surfaces, const Visible& visible,
                                                  const glm::dvec3& to_light, Visible& planes,
                                                  const Execution& execution = {}) {
  shading::ShadowMap map;
  const auto light = shading::view_of_light(visible, surfaces.bounds(), to_light, execution);
  if (!light) return map;
  planes = zbuffer(surfaces, *light, execution);
  map.draw(planes, execution);
  map.measure_from(visible.view.eye());
  return map;
}

/// The share of the light that arrives at one point, given in the form of ShadowPoints.
[[nodiscard]] inline float light_at(const shading::ShadowMap& map, const glm::vec3& position, const glm::vec3& normal,
                                    Isa isa = Isa::best) {
  float values[6][shading::batch_room] = {};
  for (int k = 0; k < 3; ++k) {
    values[k][0] = position[k];
    values[3 + k][0] = normal[k];
  }
  const bool is_asked[shading::batch_room] = {true};
  float light[shading::batch_room] = {};
  map.find_light({values[0], values[1], values[2], values[3], values[4], values[5], 1}, is_asked, light, isa);
  return light[0];
}

}  // namespace frontmost::test
