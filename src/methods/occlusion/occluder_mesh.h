// SPDX-License-Identifier: Apache-2.0
// The triangles of a mesh that hide things behind them, and which of them meet at an edge.
//
//         c          neighbours[t][k] is the triangle beyond the edge of triangle t from vertex k to the next one.
//        / \         An edge has no neighbour if it has one triangle, more than two, or two that run along it in
//     2 /   \ 1      the same direction: at such edges the surface ends, as far as hiding is concerned.
//      a-----b
//         0
#pragma once

#include <vector>

#include "frontmost/occlusion.h"
#include "surfaces/placed_scene.h"

namespace frontmost::occlusion_detail {

/// A part of a mesh: consecutive triangles, and the consecutive vertices that only these use. After a cluster's own
/// triangles come triangles of other clusters that touch it. Without these, the cluster would leave a row of cells open
/// beside the next cluster.
struct OccluderPart {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  bool is_whole = true;   ///< no triangle of the mesh's part was left out because it hides nothing
  bool is_closed = true;  ///< every side of a triangle has a neighbour
  bool has_double_sided = false, has_one_sided = false;  ///< whether the mesh's part has such triangles
  Box bounds;  ///< bounds of all triangles of the mesh's part, and of hiding triangles that touch it
  std::vector<std::uint32_t> own;  ///< indices in the mesh of the part's own triangles with finite vertices
};

struct OccluderMesh {
  std::vector<glm::vec3> positions;  ///< each position is stored once for each part that uses it
  std::vector<glm::uvec3> triangles;
  std::vector<glm::uvec3> neighbours;
  std::vector<OccluderPart> parts;  ///< at least one

  /// Calls visit(triangle) for the triangles around a corner of a triangle, from neighbour to neighbour, at most
  /// `most_around` each way.
  template <class Visit>
  void visit_around(std::uint32_t triangle, int corner, const Visit& visit) const {
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
  static constexpr int most_around = 32;
};

/// Returns the occluder mesh of an instance. It has one part, or one for each connected part, or one for each cluster.
/// O(triangles), or O(triangles log triangles) with several parts.
[[nodiscard]] OccluderMesh occluder_mesh(const PlacedScene& placed, std::uint32_t instance, ObjectUnit unit,
                                         const Execution& execution = {});

/// The most triangles of a cluster.
inline constexpr std::size_t most_in_cluster = 128;

}  // namespace frontmost::occlusion_detail
