// SPDX-License-Identifier: Apache-2.0
// Shapes of a few triangles that meshes are put together of.
#pragma once

#include "support/random_scene.h"

namespace frontmost::test {

/// Counter-clockwise as its front is seen, with the diagonal from a to c.
inline void add_quad(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

/// Faces +z, with its middle on the z axis; `half` is half of a side.
inline void add_square(Mesh& mesh, float half, float z) {
  add_quad(mesh, {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

}  // namespace frontmost::test
