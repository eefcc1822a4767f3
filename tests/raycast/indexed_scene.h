// SPDX-License-Identifier: Apache-2.0
// A scene with everything that rays need, and simple scenes.
#pragma once

#include <initializer_list>
#include <utility>

#include "frontmost/raycast.h"
#include "support/random_scene.h"

namespace frontmost::test {

struct Indexed {
  explicit Indexed(Scene s) : scene(std::move(s)), surfaces(scene), index(surfaces) {}
  Scene scene;
  Surfaces surfaces;
  RayIndex index;
};

/// The square from (-1, -1) to (1, 1) at each height, as two triangles with ids 2 i and 2 i + 1. From above, fronts are
/// seen.
inline Scene floors(std::initializer_list<float> heights) {
  Mesh mesh;
  for (const float z : heights) {
    add_triangle(mesh, {-1, -1, z}, {1, -1, z}, {1, 1, z});
    add_triangle(mesh, {-1, -1, z}, {1, 1, z}, {-1, 1, z});
  }
  return scene_of(mesh);
}

}  // namespace frontmost::test
