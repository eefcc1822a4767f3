// SPDX-License-Identifier: Apache-2.0
// The map of a light that looks at what is visible, as pictures have it.
#pragma once

#include "frontmost/zbuffer.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::test {

/// `to_light` is a unit vector.
[[nodiscard]] inline shading::ShadowMap light_map(const Surfaces& surfaces, const Visible& visible,
                                                  const glm::dvec3& to_light, const Execution& execution = {}) {
  shading::ShadowMap map;
  const auto light = shading::view_of_light(visible, surfaces.bounds(), to_light, execution);
  if (!light) return map;
  map.draw(zbuffer(surfaces, *light, execution), execution);
  map.measure_from(visible.view.eye());
  return map;
}

}  // namespace frontmost::test
