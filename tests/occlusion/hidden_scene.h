// SPDX-License-Identifier: Apache-2.0
// Scenes with much hidden: closed and open objects of all sizes, tessellated or not, mirrored and sheared, with eyes
// among them.
#pragma once

#include <algorithm>
#include <span>

#include "frontmost/occlusion.h"
#include "frontmost/view.h"
#include "support/meshes.h"

namespace frontmost::test {

/// A box about the origin with these half edges, each face `steps` x `steps` quads, without its last `open` faces.
inline Mesh tessellated_box(const glm::vec3& half, int steps, int open) {
  Mesh mesh;
  for (int face = 0; face < 6 - open; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float side = face % 2 == 0 ? 1.0f : -1.0f;
    const auto at = [&](int i, int j) {
      glm::vec3 p;
      p[axis] = side;
      p[u] = 2.0f * float(i) / float(steps) - 1.0f;
      p[v] = (2.0f * float(j) / float(steps) - 1.0f) * side;
      return p * half;
    };
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

inline glm::dmat4 random_placement(Random& random, float reach, float size) {
  glm::dmat4 m(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::vec3 column = random.point(size);
    m[axis] = glm::dvec4(glm::dvec3(column), 0.0);
  }
  const glm::vec3 place = random.point(reach);
  m[3] = glm::dvec4(glm::dvec3(place), 1.0);
  return m;
}

/// `count` objects within about two units of the origin.
inline Scene hidden_scene(int count, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  const int steps = 1 + random.below(6);
  scene.meshes.push_back(tessellated_box({1, 1, 1}, steps, 0));
  scene.meshes.push_back(tessellated_box({1, 1, 1}, 1 + random.below(3), 1 + random.below(5)));
  scene.meshes.push_back(bumpy_ball(1 + random.below(8), 0, seed));
  scene.meshes.push_back(random_mesh(all_kinds[random.below(std::size(all_kinds))], 20, seed));
  for (int i = 0; i < count; ++i) {
    const int kind = random.below(10);
    const auto mesh = std::uint32_t(kind < 4 ? 0 : kind < 7 ? 1 : kind < 9 ? 2 : 3);
    const float size = i % 20 == 0 ? 2.5f : random.unit() * random.unit() * 1.2f + 0.01f;
    const glm::dmat4 placement = random_placement(random, 2, size);
    scene.instances.push_back({"", mesh, placement});
  }
  return scene;
}

inline View random_view(int width, int height, std::uint64_t seed) {
  Random random(seed + 1000);
  const glm::vec3 eye = random.point(random.below(3) == 0 ? 1.5f : 5.0f), target = random.point(1);
  View view;
  view.width = width;
  view.height = height;
  const bool is_parallel = random.below(5) == 0;
  const double near = random.below(2) == 0 ? 0.01 : 0.2, aspect = double(width) / height;
  view.projection = is_parallel ? make_orthographic(-2 * aspect, 2 * aspect, -2, 2, {near, 40.0})
                                : make_projection(0.3 + 1.5 * double(random.unit()), aspect, {near, 40.0});
  return view.looking(glm::dvec3(eye), glm::dvec3(target), {0.1, 1, 0.2});
}

/// Number of objects with this answer.
inline std::size_t count_of(std::span<const ObjectSight> sights, ObjectSight sight) {
  return std::size_t(std::count(sights.begin(), sights.end(), sight));
}

}  // namespace frontmost::test
