// SPDX-License-Identifier: Apache-2.0
// The triangles of a mesh that hide what lies behind them, and which of them meet at an edge.
//
//         c          Neighbours are told by triangle and edge: neighbours[t][k] lies beyond the edge from
//        / \         corner k to the next one. There is none where an edge has one triangle, more than
//     2 /   \ 1      two, or two that run along it the same way: at such edges the surface ends, as far
//      a-----b       as hiding is concerned.
//         0
#pragma once

#include <vector>

#include "frontmost/occlusion.h"
#include "surfaces/placed_scene.h"

namespace frontmost::occlusion_detail {

/// Consecutive triangles, and the consecutive vertices that they alone use. Those of a cluster are followed by the
/// triangles of others that touch it: where it ends, it would else leave a row of cells open beside the next one.
struct OccluderPart {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  bool is_whole = true;   ///< all triangles of the mesh's part are there: none hides nothing
  bool is_closed = true;  ///< every side of a triangle has a neighbour
  bool has_double_sided = false, has_one_sided = false;  ///< whether the mesh's part has triangles of such materials
  Box bounds;                      ///< of all triangles of the mesh's part, and of those that touch it and hide
  std::vector<std::uint32_t> own;  ///< its triangles, as numbers in the mesh: those with finite corners
};

struct OccluderMesh {
  std::vector<glm::vec3> positions;  ///< each place once
  std::vector<glm::uvec3> triangles;
  std::vector<glm::uvec3> neighbours;
  std::vector<OccluderPart> parts;  ///< at least one

  /// Calls visit(triangle) for those that are reached from a triangle by going around a corner of it from neighbour to
  /// neighbour, at most `most_around` each way.
  template <class Visit>
  void visit_around(std::uint32_t triangle, int corner, const Visit& visit) const;
  static constexpr int most_around = 32;
};

template <class Visit>
void OccluderMesh::visit_around(std::uint32_t triangle, int corner, const Visit& visit) const {
  const std::uint32_t vertex = triangles[triangle][corner];
  const auto walk = [&](bool forwards) {
    std::uint32_t t = triangle;
    int k = corner;
    for (int step = 0; step < most_around; ++step) {
      t = neighbours[t][forwards ? k : (k + 2) % 3];
      if (t == triangle) return true;
      if (t == no_index) return false;
      visit(t);
      k = triangles[t].x == vertex ? 0 : triangles[t].y == vertex ? 1 : 2;
    }
    return false;
  };
  if (!walk(true)) walk(false);
}

/// Of the mesh of an instance. One part, or one for each that hangs together, or for each cluster. O(triangles), or
/// O(triangles log triangles) where there are several.
[[nodiscard]] OccluderMesh occluder_mesh(const PlacedScene& placed, std::uint32_t instance, ObjectUnit unit);

/// Of a cluster, at most.
inline constexpr std::size_t most_in_cluster = 128;

}  // namespace frontmost::occlusion_detail
