// SPDX-License-Identifier: Apache-2.0
// Builds a RayIndex, and makes it follow triangles that have moved. When it follows, leaves keep their triangles and
// nodes their children, and boxes are fitted anew from the leaves upwards.
//
//    refit()    clusters, as they moved --by id--> lanes of leaves --> boxes --> nodes, from the last to the first
//    follow()   leaves that hold triangles of one instance --> boxes of these leaves --> nodes above
//
// The index is built anew if a triangle has no place in the old leaves, or if a triangle of the old leaves is gone.

#include <algorithm>
#include <atomic>
#include <utility>

#include "base/parallel.h"
#include "raycast/index/ray_tree.h"

namespace frontmost {
namespace {

std::size_t byte_count(const RayTree& tree) {
  std::size_t bytes = sizeof(RayTree) + tree.nodes.size() * sizeof(RayNode) + tree.leaves.size() * sizeof(RayLeaf);
  if (tree.cutouts) bytes += tree.cutouts->byte_count();
  if (tree.sides) bytes += tree.sides->bits.size() * sizeof(std::uint32_t);
  if (tree.copies) bytes += byte_count(*tree.copies);
  if (tree.links) bytes += (tree.links->above_node.size() + tree.links->above_leaf.size()) * sizeof(std::uint32_t);
  if (tree.links && tree.links->leaves_of_instances) bytes += tree.links->leaves_of_instances->byte_count();
  return bytes;
}

/// The bounds of a node's children.
Box box_of(const RayNode& node) {
  Box box;
  for (std::size_t lane = 0; lane < node.count; ++lane)
    box.include(Box{{node.low[0][lane], node.low[1][lane], node.low[2][lane]},
                    {node.high[0][lane], node.high[1][lane], node.high[2][lane]}});
  return box;
}

constexpr std::size_t kRefitLeavesPerPart = 512, kRefitClustersPerPart = 64;

/// Returns the places of a tree's triangles, by id. A place is leaf * kRayLanes + lane, or no_index.
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
  std::size_t count = 0;
  bool have_places = true;
  visit_triangles(set, cluster, [&](std::size_t t) {
    const std::uint32_t place = places[set.id[t]];
    have_places = have_places && place != no_index;
    if (!have_places) return;
    set_corners(set, cluster, t, tree.leaves[place / kRayLanes], place % kRayLanes);
    ++count;
  });
  return have_places ? count : no_index;
}

/// Fits every node's boxes to its children.
void fit_nodes(const std::vector<Box>& boxes, RayTree& tree) {
  const auto box_of_child = [&](std::uint32_t child) {
    return child & kLeafBit ? boxes[child & ~kLeafBit] : box_of(tree.nodes[child]);
  };
  // From the last node backwards, as children come after their parents.
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    RayNode& node = tree.nodes[n];
    for (std::size_t lane = 0; lane < node.count; ++lane) node.set_box(lane, box_of_child(node.child[lane]));
  }
  tree.set_bounds(box_of_child(tree.root));
}

/// Moves the triangles of `kept` to their places in `surfaces`, and fits every box anew. \returns false if `surfaces`
/// has other triangles. The tree is then empty, as after an error: halfway it would have triangles of two scenes.
bool refit_tree(const Surfaces& surfaces, RayTree& kept, const Execution& execution) {
  RayTree tree = std::exchange(kept, RayTree());
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
  std::vector<Box> boxes(tree.leaves.size());
  parallel_for(execution, tree.leaves.size(), kRefitLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(tree.leaves[i]);
  });
  if (tree.root != no_index) fit_nodes(boxes, tree);
  kept = std::move(tree);
  return true;
}

RayLinks links_of(const RayTree& tree) {
  RayLinks links;
  links.above_node.assign(tree.nodes.size(), no_index);
  links.above_leaf.assign(tree.leaves.size(), no_index);
  for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
    for (std::uint32_t lane = 0; lane < tree.nodes[n].count; ++lane) {
      const std::uint32_t child = tree.nodes[n].child[lane];
      (child & kLeafBit ? links.above_leaf[child & ~kLeafBit] : links.above_node[child]) = n * kRayLanes + lane;
    }
  return links;
}

/// Sets the box of a leaf in the node above it, and fits the nodes above that node.
void fit_above(RayTree& tree, std::uint32_t leaf, Box box) {
  std::uint32_t link = tree.links->above_leaf[leaf];
  for (; link != no_index; link = tree.links->above_node[link / kRayLanes]) {
    RayNode& node = tree.nodes[link / kRayLanes];
    node.set_box(link % kRayLanes, box);
    box = box_of(node);
  }
  tree.set_bounds(box);
}

/// Moves an instance's triangles in a leaf. \returns their number, or no_index if a triangle is not finite any more.
std::uint32_t move_triangles(const PlacedScene& placed, std::uint32_t instance, RayLeaf& leaf) {
  const Instance& it = placed.scene->instances[instance];
  const Mesh& mesh = placed.scene->meshes[it.mesh];
  const ToWorld to_world(it.world_from_mesh);
  std::uint32_t count = 0;
  for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
    const PrimitiveId triangle = leaf.id[lane] - placed.first_primitives[instance];  // wraps around for lower ids
    if (triangle >= mesh.triangles.size()) continue;
    for (int k = 0; k < 3; ++k) {
      const int from = placed.mirrored[instance] && k > 0 ? 3 - k : k;
      const glm::vec3 corner = to_world(mesh.positions[mesh.triangles[triangle][from]]);
      if (!is_finite(corner)) return no_index;
      for (int axis = 0; axis < 3; ++axis) leaf.corner[k][axis][lane] = corner[axis];
    }
    ++count;
  }
  return count;
}

/// Returns the number of triangles of a mesh whose vertices are finite and all different.
std::uint32_t count_met(const Mesh& mesh) {
  std::uint32_t count = 0;
  for (const glm::uvec3& c : mesh.triangles) {
    const glm::vec3 &p = mesh.positions[c.x], &q = mesh.positions[c.y], &r = mesh.positions[c.z];
    count += is_finite(p) && is_finite(q) && is_finite(r) && !has_same_bits(p, q) && !has_same_bits(q, r) &&
             !has_same_bits(r, p);
  }
  return count;
}

/// Moves one instance to its place in `surfaces`, from which the tree was made. \returns false if the tree must be made
/// anew, because vertices became finite or ceased to be, or because triangles are copies of others. The tree is then
/// empty, as after an error.
bool follow_instance(const Surfaces& surfaces, std::uint32_t instance, RayTree& kept) {
  const PlacedScene& placed = placed_scene(surfaces);
  RayTree tree = std::exchange(kept, RayTree());
  tree.cutouts = placed.cutouts;
  tree.sides = placed.sides;
  if (tree.copies || tree.root == no_index) return false;
  if (!tree.links) {
    tree.links = links_of(tree);
    tree.links->leaves_of_instances =
        groups_by_instance(placed.first_primitives, tree.leaves.size(),
                           [&](std::uint32_t leaf) { return std::span(tree.leaves[leaf].id, kRayLanes); });
  }
  std::uint32_t count = 0;
  for (const std::uint32_t leaf : std::as_const(*tree.links->leaves_of_instances)[instance]) {
    const std::uint32_t moved = move_triangles(placed, instance, tree.leaves[leaf]);
    if (moved == no_index) return false;
    count += moved;
    fit_above(tree, leaf, box_of(tree.leaves[leaf]));
  }
  // The counts differ if vertices became finite.
  if (count != count_met(placed.scene->meshes[placed.scene->instances[instance].mesh])) return false;
  kept = std::move(tree);
  return true;
}

}  // namespace

RayIndex::RayIndex(const Surfaces& surfaces, const Execution& execution)
    : tree_(std::make_unique<RayTree>(make_tree(surfaces, execution))) {}
RayIndex::~RayIndex() = default;
RayIndex::RayIndex(RayIndex&&) noexcept = default;
RayIndex& RayIndex::operator=(RayIndex&&) noexcept = default;

void RayIndex::refit(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  report_progress(execution, "index", 0);
  if (!refit_tree(surfaces, *tree_, execution)) *tree_ = make_tree(surfaces, execution);
  report_progress(execution, "index", 1);
}

void RayIndex::follow(const Surfaces& surfaces, std::uint32_t instance, const Execution& execution) {
  const IeeeScope ieee;
  if (instance >= surfaces.scene().instances.size())
    throw Error(ErrorCode::bad_argument, "follow", "there is no instance " + std::to_string(instance));
  if (!follow_instance(surfaces, instance, *tree_)) *tree_ = make_tree(surfaces, execution);
}

std::uint32_t RayIndex::triangle_count() const {
  return tree_->triangle_count + (tree_->copies ? tree_->copies->triangle_count : 0);
}

const RayTree& ray_tree(const RayIndex& index) { return *index.tree_; }

const Box& RayIndex::bounds() const { return tree_->bounds; }

std::size_t RayIndex::byte_count() const { return frontmost::byte_count(*tree_); }

}  // namespace frontmost
