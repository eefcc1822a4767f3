// SPDX-License-Identifier: Apache-2.0
// Meshes of known shape: quads as building blocks, balls whose neighbouring triangles face similar ways, as normal
// cones need, and many triangles at one place.
#pragma once

#include <cmath>

#include "support/random_scene.h"

namespace frontmost::test {

/// Adds a quad, counter-clockwise seen from its front, with the diagonal from a to c.
inline void add_quad(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

/// Adds a square that faces +z, centred on the z axis; `half` is half of its side.
inline void add_square(Mesh& mesh, float half, float z) {
  add_quad(mesh, {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}
/// Adds a square perpendicular to z, as an object of its own.
inline void place_square(Scene& scene, const char* name, float half, const glm::dvec3& at) {
  Mesh mesh;
  add_square(mesh, half, 0);
  glm::dmat4 place(1.0);
  place[3] = glm::dvec4(at, 1.0);
  scene.instances.push_back({name, std::uint32_t(scene.meshes.size()), place});
  scene.meshes.push_back(std::move(mesh));
}

/// A ball of radius 1 with 8 * steps^2 triangles, counter-clockwise from outside. Every vertex is moved along its
/// radius by up to `roughness`.
inline Mesh bumpy_ball(int steps, float roughness, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::vec3 faces[8][3] = {{x, y, z},  {y, -x, z},  {-x, -y, z},  {-y, x, z},
                                 {y, x, -z}, {-x, y, -z}, {-y, -x, -z}, {x, -y, -z}};
  for (const auto& face : faces) {
    const auto first = std::uint32_t(mesh.positions.size());
    // Each row has one vertex less. Seams between the eight faces stay closed only without roughness.
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

/// Crowds of triangles. A fence stands before one long edge; dense is very small before a large square.
enum class Crowd { stack, leaning_stack, book, fan, cone, fence, dense };
inline constexpr Crowd all_crowds[] = {Crowd::stack, Crowd::leaning_stack, Crowd::book, Crowd::fan,
                                       Crowd::cone,  Crowd::fence,         Crowd::dense};

inline Mesh crowd(Crowd kind, int count) {
  Random random(3);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float t = float(i) / float(count), turn = 6.2831853f * t, next = 6.2831853f * float(i + 1) / float(count);
    switch (kind) {
      case Crowd::stack:
      case Crowd::leaning_stack: {
        const float lean = kind == Crowd::stack ? 0.0f : 0.3f;
        add_triangle(mesh, {-1, -1, t}, {1, -1, t + lean}, {1, 1, t + 2 * lean});
        add_triangle(mesh, {-1, -1, t}, {1, 1, t + 2 * lean}, {-1, 1, t + lean});
        break;
      }
      case Crowd::book: add_triangle(mesh, {0, 0, -1}, {0, 0, 1}, {std::cos(turn), std::sin(turn), t}); break;
      case Crowd::fan: add_triangle(mesh, {0, 0, -1}, {0, 0, 1}, random.point(1)); break;
      case Crowd::cone:
        add_triangle(mesh, {0, 0, 1}, {std::cos(turn), std::sin(turn), 0}, {std::cos(next), std::sin(next), 0});
        break;
      case Crowd::fence: {
        if (i == 0) add_triangle(mesh, {1, 0, 0}, {-1, 0, 0}, {0, -1, -1});
        const float left = 2 * t - 1, right = left + 1 / float(count);
        add_triangle(mesh, {left, -0.1f, 0.1f}, {right, -0.1f, 0.1f}, {0.5f * (left + right), 0.1f, 0.2f});
        break;
      }
      case Crowd::dense: {
        if (i == 0) add_triangle(mesh, {-1, -1, -1}, {1, -1, -1}, {0, 1, -1});
        const glm::vec3 p = random.point(0.01f);
        const glm::vec3 q = p + random.point(0.01f / std::sqrt(float(count)));
        add_triangle(mesh, p, q, p + random.point(0.01f / std::sqrt(float(count))));
        break;
      }
    }
  }
  return mesh;
}

}  // namespace frontmost::test
