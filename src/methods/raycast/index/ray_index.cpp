// SPDX-License-Identifier: Apache-2.0
// RayIndex: the steps of its constructors and of refit(), and their order.

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {

namespace {

void build(RayTree& tree, const Execution& execution) {
  std::vector<LeafBox> boxes = group_leaves(tree, execution);
  report_progress(execution, "index", 0.5);
  build_nodes(boxes, tree, execution);
}

std::size_t byte_count(const RayLinks& links) {
  return (links.above_node.size() + links.above_leaf.size()) * sizeof(std::uint32_t) +
         (links.leaves_of_instances ? links.leaves_of_instances->byte_count() : 0);
}

std::size_t byte_count(const RayTree& tree) {
  return sizeof(RayTree) + tree.nodes.size() * sizeof(RayNode) + tree.leaves.size() * sizeof(RayLeaf) +
         (tree.cutouts ? tree.cutouts->byte_count() : 0) +
         (tree.sides ? tree.sides->bits.size() * sizeof(std::uint32_t) : 0) +
         (tree.copies ? byte_count(*tree.copies) : 0) + (tree.links ? byte_count(*tree.links) : 0);
}

RayTree make_tree(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  RayTree tree;
  tree.cutouts = placed_scene(surfaces).cutouts;
  tree.sides = placed_scene(surfaces).sides;
  report_progress(execution, "index", 0);
  fill_leaves(surfaces, tree, execution);
  tree.copies = take_copies(tree, execution);
  build(tree, execution);
  if (tree.copies) build(*tree.copies, execution);
  report_progress(execution, "index", 1);
  return tree;
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
