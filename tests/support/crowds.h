// SPDX-License-Identifier: Apache-2.0
// Many triangles at one place.
#pragma once

#include <cmath>

#include "support/random_scene.h"

namespace frontmost::test {

/// A fence stands before one long edge; dense is very small before a large square.
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
