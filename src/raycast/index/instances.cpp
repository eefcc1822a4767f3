// SPDX-License-Identifier: Apache-2.0
// Two levels: trees over meshes where they are modelled, and a tree over the instances.
//
// A box is placed where a walk comes to it, so that instances cost a matrix each. Instances may be singular, so rays
// are never turned into the space of a mesh.
// (I. Wald, C. Benthin, P. Slusallek. Distributed Interactive Ray Tracing of Dynamic Scenes. 2003.)

#include <algorithm>

#include "base/parallel.h"
#include "raycast/index/build.h"
#include "raycast/index/placement.h"

namespace frontmost {
namespace {

/// Over one mesh, where it is modelled; ids count its triangles.
RayTree tree_of(const Mesh& mesh, const Execution& execution) {
  Scene alone;
  Mesh& shape = alone.meshes.emplace_back();
  shape.positions = mesh.positions;
  shape.triangles = mesh.triangles;
  alone.instances.push_back({});
  return make_tree(Surfaces(alone, execution), RepeatedTriangles::among_all, execution);
}

/// Trees one after the other in the arrays of one.
class Forest {
 public:
  explicit Forest(std::vector<RayTree> trees) : trees_(std::move(trees)) {
    for (const RayTree& tree : trees_) {
      first_node_.push_back(nodes_);
      first_leaf_.push_back(leaves_);
      nodes_ += std::uint32_t(tree.nodes.size());
      leaves_ += std::uint32_t(tree.leaves.size());
    }
  }

  [[nodiscard]] std::uint32_t child(std::size_t tree, std::uint32_t child) const {
    return child + (child & kLeafBit ? first_leaf_[tree] : first_node_[tree]);
  }
  [[nodiscard]] std::uint32_t root(std::size_t tree) const {
    return trees_[tree].root == no_index ? no_index : child(tree, trees_[tree].root);
  }
  [[nodiscard]] const RayTree& operator[](std::size_t tree) const { return trees_[tree]; }

  /// Each tree goes as soon as it is copied.
  void move_to(RayTree& all) {
    all.nodes = Buffer<RayNode>(nodes_);
    all.leaves = Buffer<RayLeaf>(leaves_);
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      const RayTree tree = std::move(trees_[t]);
      std::copy(tree.leaves.begin(), tree.leaves.end(), all.leaves.begin() + first_leaf_[t]);
      for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        RayNode& node = all.nodes[first_node_[t] + n] = tree.nodes[n];
        for (std::size_t lane = 0; lane < node.count; ++lane) node.child[lane] = child(t, node.child[lane]);
      }
    }
  }

 private:
  std::vector<RayTree> trees_;
  std::vector<std::uint32_t> first_node_, first_leaf_;
  std::uint32_t nodes_ = 0, leaves_ = 0;
};

}  // namespace

Box placed_box(const RayTree& tree, const PlacedRoot& by) {
  Box box;
  if (by.root & kLeafBit) {
    RayLeaf leaf;
    raycast_detail::place(by, tree.leaves[by.root & ~kLeafBit], leaf);
    for (std::size_t lane = 0; lane < kRayLanes; ++lane)
      if (leaf.id[lane] != no_primitive)
        for (const auto& corner : leaf.corner) box.include({corner[0][lane], corner[1][lane], corner[2][lane]});
    return box;
  }
  RayNode node;
  raycast_detail::place(by, tree.nodes[by.root], node);
  for (std::size_t lane = 0; lane < node.count; ++lane)
    for (int axis = 0; axis < 3; ++axis) {
      // Where floats end, the box has no end.
      const float low = node.low[axis][lane], high = node.high[axis][lane];
      constexpr float most = std::numeric_limits<float>::max();
      box.low[axis] = std::min(box.low[axis], std::isnan(low) ? -most : std::max(low, -most));
      box.high[axis] = std::max(box.high[axis], std::isnan(high) ? most : std::min(high, most));
    }
  return box;
}

namespace {

/// The tree over the instances goes behind the nodes of the meshes.
void build_upper(RayTree& tree, const Execution& execution) {
  std::vector<LeafBox> boxes(tree.placed.size());
  constexpr std::size_t kInstancesPerPart = 1024;
  parallel_for(execution, boxes.size(), kInstancesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Box box;
      if (tree.placed[i].root != no_index) box = placed_box(tree, tree.placed[i]);
      boxes[i] = {{box.low.x, box.low.y, box.low.z}, std::uint32_t(i), {box.high.x, box.high.y, box.high.z}, 0};
    }
  });
  // Meshes without triangles, and instances that take all of theirs beyond the floats.
  std::erase_if(boxes, [](const LeafBox& box) { return box.low[0] > box.high[0]; });
  RayTree upper;
  build_nodes(boxes, upper, execution);
  Buffer<RayNode> nodes(tree.mesh_nodes + upper.nodes.size());
  std::copy_n(tree.nodes.begin(), tree.mesh_nodes, nodes.begin());
  for (std::size_t n = 0; n < upper.nodes.size(); ++n) {
    RayNode& node = nodes[tree.mesh_nodes + n] = upper.nodes[n];
    for (std::size_t lane = 0; lane < node.count; ++lane)
      if (!(node.child[lane] & kLeafBit)) node.child[lane] += tree.mesh_nodes;
  }
  tree.nodes = std::move(nodes);
  tree.root = upper.root == no_index || upper.root & kLeafBit ? upper.root : upper.root + tree.mesh_nodes;
  tree.depth = tree.mesh_depth + upper.depth + 1;
  tree.bounds = upper.bounds;
}

/// Holes are looked up in the world: as many triangles with holes as all instances have together. Sides are told by
/// instance as well.
void set_materials(const Scene& scene, RayTree& tree) {
  std::vector<PrimitiveId> first = {0};
  for (const Instance& instance : scene.instances)
    first.push_back(first.back() + PrimitiveId(scene.meshes[instance.mesh].triangles.size()));
  tree.cutouts = Cutouts::of(scene, first);
  tree.sides = MaterialSides::of(scene, first);
}

}  // namespace

void place_instance(const Instance& instance, PlacedRoot& placed) {
  placed.world_from_mesh = instance.world_from_mesh;
  placed.is_mirrored = mirrors(instance.world_from_mesh);
}

RayTree make_placed_tree(const Scene& scene, const Execution& execution) {
  const IeeeScope ieee;
  validate(scene);
  check_transforms(scene);
  std::vector<std::uint8_t> is_used(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) is_used[instance.mesh] = 1;
  // Progress is told by mesh; each of their builds would begin again at 0.
  const Execution unwatched{execution.threads, execution.isa, nullptr};
  std::vector<RayTree> trees(scene.meshes.size());
  for (std::size_t m = 0; m < trees.size(); ++m) {
    report_progress(execution, "index", double(m) / double(trees.size()));
    if (is_used[m]) trees[m] = tree_of(scene.meshes[m], unwatched);
  }

  RayTree tree;
  Forest forest(std::move(trees));
  PrimitiveId first = 0;
  for (const Instance& instance : scene.instances) {
    PlacedRoot& placed = tree.placed.emplace_back();
    placed.mesh = instance.mesh;
    placed.first = first;
    placed.root = forest.root(instance.mesh);
    place_instance(instance, placed);
    tree.triangle_count += forest[instance.mesh].triangle_count;
    tree.mesh_depth = std::max(tree.mesh_depth, forest[instance.mesh].depth);
    first += PrimitiveId(scene.meshes[instance.mesh].triangles.size());
  }
  forest.move_to(tree);
  set_materials(scene, tree);
  tree.mesh_nodes = std::uint32_t(tree.nodes.size());
  build_upper(tree, execution);
  report_progress(execution, "index", 1);
  return tree;
}

bool replace_instances(const Scene& scene, RayTree& tree, const Execution& execution) {
  if (tree.placed.empty() || tree.placed.size() != scene.instances.size()) return false;
  PrimitiveId first = 0;
  for (std::size_t i = 0; i < tree.placed.size(); ++i) {
    const std::uint32_t mesh = scene.instances[i].mesh;
    if (mesh != tree.placed[i].mesh || mesh >= scene.meshes.size() || first != tree.placed[i].first) return false;
    first += PrimitiveId(scene.meshes[mesh].triangles.size());
  }
  check_transforms(scene);
  TreeChange change(tree);
  for (std::size_t i = 0; i < tree.placed.size(); ++i) place_instance(scene.instances[i], tree.placed[i]);
  if (tree.cutouts) set_materials(scene, tree);
  tree.links.reset();
  build_upper(tree, execution);
  change.complete();
  return true;
}

}  // namespace frontmost
