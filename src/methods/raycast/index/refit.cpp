// SPDX-License-Identifier: Apache-2.0
// Updates a RayIndex after its triangles have moved: leaves keep their triangles and nodes their children, and boxes
// are fitted anew from the leaves upwards.
//
//    clusters, as they moved --by id--> lane of a leaf        all triangles have a place in the old leaves
//    leaves --> boxes --> nodes, from the last to the first    children come after their parents
//
// If a triangle has no place, or one has gone, the index must be built anew: refitting never changes which triangles
// share a leaf.

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {
namespace {

constexpr std::size_t kRefitLeavesPerPart = 512, kRefitClustersPerPart = 64;

/// The places of a tree's triangles, by id: leaf * 16 + lane, or no_index.
Buffer<std::uint32_t> places_of(const RayTree& tree, std::size_t id_count, const Execution& execution) {
  Buffer<std::uint32_t> places(id_count, no_index);
  parallel_for(execution, tree.leaves.size(), kRefitLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * kRayLanes; i < end * kRayLanes; ++i) {
      const PrimitiveId id = tree.leaves[i / kRayLanes].id[i % kRayLanes];
      if (id < id_count) places[id] = std::uint32_t(i);  // no_primitive is not less
    }
  });
  return places;
}

/// Moves the triangles of a cluster. Clusters and leaves run through space in nearly the same order, so this order of
/// work jumps least through memory. \returns how many triangles were moved, or no_index if one has no place.
std::size_t move_triangles(const ClusterSet& set, const Cluster& cluster, const Buffer<std::uint32_t>& places,
                           RayTree& tree) {
  const float* const positions[3] = {set.x.data() + cluster.first_vertex, set.y.data() + cluster.first_vertex,
                                     set.z.data() + cluster.first_vertex};
  std::size_t count = 0;
  const std::size_t first = cluster.first_triangle;
  for (std::size_t t = first; t < first + cluster.triangle_count; ++t) {
    if (is_degenerate(set, t)) continue;
    const std::uint32_t place = places[set.id[t]];
    if (place == no_index) return no_index;
    set_corners(set, t, positions, tree.leaves[place / kRayLanes], place % kRayLanes);
    ++count;
  }
  return count;
}

/// Fits every node's boxes to its children.
void fit_nodes(const std::vector<LeafBox>& boxes, RayTree& tree) {
  const auto box_of_child = [&](std::uint32_t child) {
    return child & kLeafBit ? as_box(boxes[child & ~kLeafBit]) : box_of(tree.nodes[child]);
  };
  // From the last node backwards, as children come after their parents.
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    RayNode& node = tree.nodes[n];
    for (std::size_t lane = 0; lane < node.count; ++lane) {
      const Box box = box_of_child(node.child[lane]);
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][lane] = box.low[axis];
        node.high[axis][lane] = box.high[axis];
      }
    }
  }
  tree.bounds = box_of_child(tree.root);
}

}  // namespace

bool refit_tree(const Surfaces& surfaces, RayTree& tree, const Execution& execution) {
  TreeChange change(tree);
  // Copies may move apart.
  if (tree.copies) return false;
  const ClusterSet& set = cluster_set(surfaces, execution);
  tree.cutouts = set.cutouts;
  tree.sides = placed_scene(surfaces).sides;
  const Buffer<std::uint32_t> places = places_of(tree, surfaces.primitive_count(), execution);
  std::atomic<std::size_t> moved{0};
  parallel_for(execution, set.clusters.size(), kRefitClustersPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) moved += move_triangles(set, set.clusters[c], places, tree);
  });
  // The count is too high if a triangle has no place, and too low if a triangle cannot be met any more.
  if (moved != tree.triangle_count) return false;
  if (tree.root == no_index) {
    change.complete();
    return true;
  }
  std::vector<LeafBox> boxes(tree.leaves.size());
  parallel_for(execution, tree.leaves.size(), kRefitLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(tree.leaves[i], std::uint32_t(i));
  });
  fit_nodes(boxes, tree);
  change.complete();
  return true;
}

}  // namespace frontmost
