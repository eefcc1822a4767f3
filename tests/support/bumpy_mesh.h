// SPDX-License-Identifier: Apache-2.0
// Surfaces whose neighbouring triangles face about the same way: what normal cones are good for.
#pragma once

#include "support/random_scene.h"

namespace frontmost::test {

/// A ball of radius 1 of 8 * steps^2 triangles, counter-clockwise from outside, every vertex moved along its radius by
/// up to `roughness`.
inline Mesh bumpy_ball(int steps, float roughness, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::vec3 faces[8][3] = {{x, y, z},  {y, -x, z},  {-x, -y, z},  {-y, x, z},
                                 {y, x, -z}, {-x, y, -z}, {-y, -x, -z}, {x, -y, -z}};
  for (const auto& face : faces) {
    const auto first = std::uint32_t(mesh.positions.size());
    // Rows of one vertex less each. Seams between the eight faces stay closed only without roughness.
    const auto number = [&](int i, int j) { return first + std::uint32_t(i * (steps + 1) - i * (i - 1) / 2 + j); };
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const float u = float(i) / float(steps), v = float(j) / float(steps);
        mesh.positions.push_back(glm::normalize(face[0] * (1 - u - v) + face[1] * u + face[2] * v) *
                                 (1 + roughness * random.unit()));
      }
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        mesh.triangles.push_back({number(i, j), number(i + 1, j), number(i, j + 1)});
        if (i + j + 1 < steps) mesh.triangles.push_back({number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)});
      }
  }
  return mesh;
}

}  // namespace frontmost::test
