// SPDX-License-Identifier: Apache-2.0
// Interpolation for one fragment, as the kernel does it for many at once.
#pragma once

#include "shade/geometry/geometry.h"

namespace frontmost::shading {

template <class T>
[[nodiscard]] T interpolate(const std::array<T, 3>& corner, const glm::vec3& weight) {
  return corner[0] * weight.x + corner[1] * weight.y + corner[2] * weight.z;
}

/// Change per pixel of an attribute that has `value` at the position of `b`: exact derivatives of the quotient.
struct Gradient {
  glm::vec2 dx, dy;
};
[[nodiscard]] inline Gradient gradient(const TriangleSetup& t, const std::array<glm::vec2, 3>& corner,
                                       const glm::vec2& value, const Barycentric& b) {
  Gradient g{glm::vec2(0), glm::vec2(0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec2 difference = corner[k] - value;
    g.dx += difference * t.weight[k].step_x;
    g.dy += difference * t.weight[k].step_y;
  }
  const float scale = 1.0f / b.divisor;
  return {g.dx * scale, g.dy * scale};
}

}  // namespace frontmost::shading
