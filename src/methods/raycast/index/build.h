// SPDX-License-Identifier: Apache-2.0
// Building a RayTree, and what moving one needs of it.
#pragma once

#include <vector>

#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// The bounds of the leaf's triangles; unused lanes do not count.
[[nodiscard]] Box box_of(const RayLeaf& leaf);

/// The tree of the surfaces.
[[nodiscard]] RayTree make_tree(const Surfaces& surfaces, const Execution& execution);

/// Calls visit(t) for the triangles of a cluster of which no two vertices are the same. No ray meets another one;
/// Surfaces makes vertices the same to mark a triangle that is not finite.
template <class Visit>
void visit_triangles(const ClusterSet& set, const Cluster& cluster, const Visit& visit) {
  for (std::size_t t = cluster.first_triangle; t < cluster.first_triangle + cluster.triangle_count; ++t)
    if (set.i0[t] != set.i1[t] && set.i1[t] != set.i2[t] && set.i2[t] != set.i0[t]) visit(t);
}

/// Sets the vertices of triangle `t` of a cluster in a lane.
inline void set_corners(const ClusterSet& set, const Cluster& cluster, std::size_t t, RayLeaf& leaf, std::size_t lane) {
  const std::size_t corners[3] = {set.i0[t], set.i1[t], set.i2[t]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = cluster.first_vertex + corners[k];
    leaf.corner[k][0][lane] = set.x[v];
    leaf.corner[k][1][lane] = set.y[v];
    leaf.corner[k][2][lane] = set.z[v];
  }
}

}  // namespace frontmost
