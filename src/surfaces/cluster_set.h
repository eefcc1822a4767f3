// SPDX-License-Identifier: Apache-2.0
// The inside of Surfaces: clusters of triangles as structure of arrays, the form in which every method reads geometry.
#pragma once

#include <vector>

#include "frontmost/surfaces.h"

namespace frontmost {

/// Up to 64 vertices and 124 triangles of one instance, with consecutive primitive ids. Its vertices start at
/// `first_vertex` of ClusterSet::x, y, z; its corner numbers (0 to 63, relative) at `first_corner` of i0, i1, i2.
/// Both are padded to whole vectors of 16: padding vertices repeat the first one, padding triangles are degenerate.
struct Cluster {
  static constexpr int max_vertices = 64;
  static constexpr int max_triangles = 124;
  static constexpr int lanes = 16;

  std::uint64_t first_vertex = 0;
  std::uint64_t first_corner = 0;
  PrimitiveId first_primitive = 0;
  std::uint16_t vertex_count = 0;
  std::uint16_t triangle_count = 0;
};

struct ClusterSet {
  const Scene* scene = nullptr;
  std::vector<PrimitiveId> first_primitives;  ///< by instance, and the total at the end
  std::vector<Box> instance_bounds;
  Box bounds;

  std::vector<Cluster> clusters;  ///< in id order
  /// World-space boxes of the clusters, in the same order; empty where no corner is finite.
  std::vector<Box> boxes;
  Buffer<float> x, y, z;  ///< world space
  Buffer<std::uint8_t> i0, i1, i2;
};

/// The world-space position of a vertex, in the one rounding that every part of the house uses.
[[nodiscard]] inline glm::vec3 to_world(const glm::dmat4& world_from_mesh, const glm::vec3& p) {
  const glm::dvec3 q(p);
  const glm::dmat4& m = world_from_mesh;
  return {float(m[0][0] * q.x + m[1][0] * q.y + m[2][0] * q.z + m[3][0]),
          float(m[0][1] * q.x + m[1][1] * q.y + m[2][1] * q.z + m[3][1]),
          float(m[0][2] * q.x + m[1][2] * q.y + m[2][2] * q.z + m[3][2])};
}

}  // namespace frontmost
