// SPDX-License-Identifier: Apache-2.0
// From a triangle of a cluster to one of a leaf.
#pragma once

#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// Two corners the same: no ray meets it, or it is one that Surfaces has set aside as not finite.
inline bool is_degenerate(const ClusterSet& set, std::size_t t) {
  return set.i0[t] == set.i1[t] || set.i1[t] == set.i2[t] || set.i2[t] == set.i0[t];
}

/// Of triangle `t`, whose cluster's vertices are `positions`, by axis.
inline void set_corners(const ClusterSet& set, std::size_t t, const float* const (&positions)[3], RayLeaf& leaf,
                        std::size_t lane) {
  const std::uint8_t corners[3] = {set.i0[t], set.i1[t], set.i2[t]};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) leaf.corner[k][axis][lane] = positions[axis][corners[k]];
}

}  // namespace frontmost
