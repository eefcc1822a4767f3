// SPDX-License-Identifier: Apache-2.0
// The leaves of a RayIndex: triangles in the surfaces' spatial order, sixteen at a time.
//
// Clusters already are in spatial order, so cutting their sequence into sixteens needs no further sort. The place of a
// triangle depends on how many triangles go before it, so triangles are counted first. Redistributing groups of sixteen
// leaves doubles the time of a build, and makes single rays 20 to 40 % and views up to 10 % faster.
//
//    clusters     [.......][......][........]         counted in parts, so that every part knows where its triangles go
//    leaves       [ 16 ][ 16 ][ 16 ][ 16 ] ...        their triangles, cut into sixteens
//    regrouped    sixteen leaves at a time            so that each leaf is small

#include <algorithm>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {
namespace {

constexpr std::size_t kClustersPerPart = 64;
constexpr std::size_t kLeavesPerPart = 1024;

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
    set_corners(set, t, positions, leaf, lane);
    leaf.id[lane] = set.id[t];
    ++place;
  }
}

/// Redistributes the triangles of a group of whole leaves: halves them by the middle triangle along the longest side of
/// their centres' box, until sixteen are left. The spatial order alone makes leaves that bend around its turns.
class Regrouping {
 public:
  static constexpr std::size_t kLeaves = 16;

  void regroup(RayLeaf* leaves, std::size_t leaf_count) {
    const std::size_t count = leaf_count * kRayLanes;
    for (std::size_t i = 0; i < count; ++i) {
      centres_[i].triangle = std::uint16_t(i);
      for (std::size_t axis = 0; axis < 3; ++axis)
        centres_[i].at[axis] = centre(leaves[i / kRayLanes], axis, i % kRayLanes);
    }
    halve(0, leaf_count);
    std::copy_n(leaves, leaf_count, before_);
    for (std::size_t i = 0; i < count; ++i) {
      const RayLeaf& from = before_[centres_[i].triangle / kRayLanes];
      RayLeaf& to = leaves[i / kRayLanes];
      const std::size_t from_lane = centres_[i].triangle % kRayLanes, to_lane = i % kRayLanes;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) to.corner[k][axis][to_lane] = from.corner[k][axis][from_lane];
      to.id[to_lane] = from.id[from_lane];
    }
  }

 private:
  struct Centre {
    float at[3];
    std::uint16_t triangle;
  };

  /// Centre of the triangle's box. Halves are added, as the sum of two large floats overflows.
  static float centre(const RayLeaf& leaf, std::size_t axis, std::size_t lane) {
    const float a = leaf.corner[0][axis][lane], b = leaf.corner[1][axis][lane], c = leaf.corner[2][axis][lane];
    return 0.5f * std::min({a, b, c}) + 0.5f * std::max({a, b, c});
  }

  void halve(std::size_t first_leaf, std::size_t leaf_count) {
    if (leaf_count < 2) return;
    Centre* const begin = centres_ + first_leaf * kRayLanes;
    Centre* const end = begin + leaf_count * kRayLanes;
    std::size_t longest = 0;
    float most = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float low = begin->at[axis], high = low;
      for (const Centre* c = begin; c < end; ++c) low = std::min(low, c->at[axis]), high = std::max(high, c->at[axis]);
      if (high - low > most) longest = axis, most = high - low;
    }
    const std::size_t left = leaf_count / 2;
    std::nth_element(begin, begin + left * kRayLanes, end,
                     [longest](const Centre& a, const Centre& b) { return a.at[longest] < b.at[longest]; });
    halve(first_leaf, left);
    halve(first_leaf + left, leaf_count - left);
  }

  Centre centres_[kLeaves * kRayLanes];
  RayLeaf before_[kLeaves];
};

}  // namespace

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

void fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution) {
  const ClusterSet& set = cluster_set(surfaces, execution);
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
}

std::vector<LeafBox> group_leaves(RayTree& tree, const Execution& execution) {
  const std::size_t total = tree.triangle_count, leaf_count = tree.leaves.size();
  std::vector<LeafBox> boxes(leaf_count);
  parallel_for(execution, leaf_count, kLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    // The last leaf, if not full, stays as it is, with its unused lanes at the end.
    const std::size_t whole_end = std::min(end, total / kRayLanes);
    Regrouping regrouping;
    for (std::size_t i = begin; i + 1 < whole_end; i += Regrouping::kLeaves)
      regrouping.regroup(tree.leaves.data() + i, std::min(Regrouping::kLeaves, whole_end - i));
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(tree.leaves[i], static_cast<std::uint32_t>(i));
  });
  return boxes;
}

}  // namespace frontmost
