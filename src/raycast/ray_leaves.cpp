// SPDX-License-Identifier: Apache-2.0
// The leaves of a RayIndex: triangles in the surfaces' spatial order, sixteen at a time.
//
// Clusters already are in Morton order, and cutting their run into sixteens costs no sort of our own. The place of a
// triangle depends on how many go before it, so that they are counted first.

#include <algorithm>

#include "base/parallel.h"
#include "raycast/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {
namespace {

constexpr std::size_t kClustersPerPart = 64;
constexpr std::size_t kLeavesPerPart = 1024;

/// Two corners the same: no ray meets it, or it is one that Surfaces has set aside as not finite.
bool is_degenerate(const ClusterSet& set, std::size_t t) {
  return set.i0[t] == set.i1[t] || set.i1[t] == set.i2[t] || set.i2[t] == set.i0[t];
}

std::uint32_t count_triangles(const ClusterSet& set, std::size_t begin, std::size_t end) {
  std::uint32_t count = 0;
  for (std::size_t c = begin; c < end; ++c) {
    const Cluster& cluster = set.clusters[c];
    const std::size_t first = cluster.first_triangle;
    for (std::size_t t = first; t < first + cluster.triangle_count; ++t) count += !is_degenerate(set, t);
  }
  return count;
}

void fill(const ClusterSet& set, const Cluster& cluster, std::size_t& place, Buffer<RayLeaf>& leaves) {
  const float* const positions[3] = {set.x.data() + cluster.first_vertex, set.y.data() + cluster.first_vertex,
                                     set.z.data() + cluster.first_vertex};
  const std::size_t first = cluster.first_triangle;
  for (std::size_t t = first; t < first + cluster.triangle_count; ++t) {
    if (is_degenerate(set, t)) continue;
    RayLeaf& leaf = leaves[place / kRayLanes];
    const std::size_t lane = place % kRayLanes;
    const std::uint8_t corners[3] = {set.i0[t], set.i1[t], set.i2[t]};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) leaf.corner[k][axis][lane] = positions[axis][corners[k]];
    leaf.id[lane] = set.id[t];
    ++place;
  }
}

LeafBox box_of(const RayLeaf& leaf, std::uint32_t number) {
  std::size_t count = kRayLanes;
  while (count > 1 && leaf.id[count - 1] == no_primitive) --count;
  LeafBox box{};
  box.leaf = number;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = leaf.corner[0][axis][0], high = low;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t lane = 0; lane < count; ++lane) {
        low = std::min(low, leaf.corner[k][axis][lane]);
        high = std::max(high, leaf.corner[k][axis][lane]);
      }
    box.low[axis] = low;
    box.high[axis] = high;
  }
  return box;
}

}  // namespace

std::vector<LeafBox> fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution) {
  const ClusterSet& set = surfaces.clusters();
  const std::size_t parts = (set.clusters.size() + kClustersPerPart - 1) / kClustersPerPart;
  std::vector<std::size_t> first(parts + 1, 0);
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    first[begin / kClustersPerPart + 1] = count_triangles(set, begin, end);
  });
  for (std::size_t i = 0; i < parts; ++i) first[i + 1] += first[i];

  const std::size_t total = first.back(), leaf_count = (total + kRayLanes - 1) / kRayLanes;
  tree.triangle_count = static_cast<std::uint32_t>(total);
  tree.leaves = Buffer<RayLeaf>(leaf_count);
  if (total % kRayLanes != 0) {
    tree.leaves[leaf_count - 1] = {};
    std::fill_n(tree.leaves[leaf_count - 1].id, kRayLanes, no_primitive);
  }
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t place = first[begin / kClustersPerPart];
    for (std::size_t c = begin; c < end; ++c) fill(set, set.clusters[c], place, tree.leaves);
  });

  std::vector<LeafBox> boxes(leaf_count);
  parallel_for(execution, leaf_count, kLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(tree.leaves[i], static_cast<std::uint32_t>(i));
  });
  return boxes;
}

}  // namespace frontmost
