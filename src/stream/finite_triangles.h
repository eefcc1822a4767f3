// SPDX-License-Identifier: Apache-2.0
// The triangles of a mesh that count: those whose corners are all finite.
#pragma once

#include "frontmost/scene.h"
#include "surfaces/cluster_set.h"

namespace frontmost::streaming {

/// Calls visit(corner, corner, corner) for those from `begin` to `end`.
template <class Visit>
void for_finite_triangles(const Mesh& mesh, std::size_t begin, std::size_t end, const Visit& visit) {
  for (std::size_t t = begin; t < end; ++t) {
    const glm::uvec3& corners = mesh.triangles[t];
    const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y], &c = mesh.positions[corners.z];
    if (is_finite(a) && is_finite(b) && is_finite(c)) visit(a, b, c);
  }
}

[[nodiscard]] inline Box finite_bounds(const Mesh& mesh, std::size_t begin, std::size_t end) {
  Box box;
  for_finite_triangles(mesh, begin, end, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    box.include(Box{glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  });
  return box;
}

}  // namespace frontmost::streaming
