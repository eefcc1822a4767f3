// SPDX-License-Identifier: Apache-2.0
// Building a RayTree, and the parts of it that moving triangles needs, too.
#pragma once

#include <vector>

#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// Bounds of a leaf, for building nodes.
struct LeafBox {
  float low[3];
  std::uint32_t leaf;
  float high[3];
  std::uint32_t unused;
};
[[nodiscard]] inline Box as_box(const LeafBox& b) {
  return {{b.low[0], b.low[1], b.low[2]}, {b.high[0], b.high[1], b.high[2]}};
}

/// Returns the bounds of the leaf's triangles, without unused lanes. `number` is the index of the leaf.
[[nodiscard]] LeafBox box_of(const RayLeaf& leaf, std::uint32_t number);

/// Makes the tree of the surfaces.
[[nodiscard]] RayTree make_tree(const Surfaces& surfaces, const Execution& execution);

/// Returns whether two vertices are the same. No ray meets such a triangle. Surfaces marks triangles that are not
/// finite by making their vertices the same.
inline bool is_degenerate(const ClusterSet& set, std::size_t t) {
  return set.i0[t] == set.i1[t] || set.i1[t] == set.i2[t] || set.i2[t] == set.i0[t];
}

/// Sets the vertices of triangle `t` in a lane. `positions` are the vertices of its cluster, by axis.
inline void set_corners(const ClusterSet& set, std::size_t t, const float* const (&positions)[3], RayLeaf& leaf,
                        std::size_t lane) {
  const std::uint8_t corners[3] = {set.i0[t], set.i1[t], set.i2[t]};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) leaf.corner[k][axis][lane] = positions[axis][corners[k]];
}

}  // namespace frontmost
