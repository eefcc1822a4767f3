// SPDX-License-Identifier: Apache-2.0
// Small meshes for which comparing every two triangles takes minutes.
#pragma once

#include "support/meshes.h"

namespace frontmost::test {

/// Triangles in one plane, rotated about their common centre: all overlap in the middle.
inline Mesh turned_triangles(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto corner = [&](int k) {
      const double turn = 2.0943951023931953 * (k + double(i) / count);
      return glm::vec3(std::cos(turn), std::sin(turn), 0);
    };
    add_triangle(mesh, corner(0), corner(1), corner(2));
  }
  return mesh;
}

/// Equal squares, each `gap` nearer to +z than the previous one.
inline Mesh parallel_sheets(int count, double gap) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) add_square(mesh, 1, float(i * gap));
  return mesh;
}

/// Squares in one plane about one centre, each larger than the previous one.
inline Mesh nested_sheets(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) add_square(mesh, 0.1f + 0.9f * float(i) / float(count), 0);
  return mesh;
}

/// Long narrow rectangles one behind the other, in all directions of a plane.
inline Mesh crossing_strips(int count) {
  Random random(2);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float turn = 3.14159f * random.unit(), z = float(i) / float(count);
    const glm::vec3 along(std::cos(turn), std::sin(turn), 0), aside(-0.002f * along.y, 0.002f * along.x, 0),
        at(0, 0, z);
    add_triangle(mesh, at - along - aside, at + along - aside, at + along + aside);
    add_triangle(mesh, at - along - aside, at + along + aside, at - along + aside);
  }
  return mesh;
}

/// Very thin triangles of length 2 through one point, in all directions of a plane.
inline Mesh flat_slivers(int count) {
  Random random(4);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float turn = 3.14159f * random.unit();
    const glm::vec3 along(std::cos(turn), std::sin(turn), 0), aside(-1e-4f * along.y, 1e-4f * along.x, 0);
    add_triangle(mesh, -along - aside, -along + aside, along);
  }
  return mesh;
}

/// Very thin triangles of length 2 through one point, in all directions of space.
inline Mesh slivers_through_point(int count) {
  Random random(3);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 along = glm::normalize(random.point(1) + glm::vec3(1e-3f, 0, 0));
    const glm::vec3 aside = 1e-4f * glm::normalize(glm::cross(along, glm::vec3(0.36f, 0.48f, 0.8f)));
    add_triangle(mesh, -along - aside, -along + aside, along);
  }
  return mesh;
}

}  // namespace frontmost::test
