// SPDX-License-Identifier: Apache-2.0
// RayIndex: what its constructors and refit() do, and in what order.

#include "base/float_environment.h"
#include "base/parallel.h"
#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

RayTree make_tree(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  RayTree tree;
  tree.cutouts = surfaces.clusters().cutouts;
  report_progress(execution, "index", 0);
  std::vector<LeafBox> boxes = fill_leaves(surfaces, tree, execution);
  report_progress(execution, "index", 0.5);
  build_nodes(boxes, tree, execution);
  report_progress(execution, "index", 1);
  return tree;
}

RayIndex::RayIndex(const Surfaces& surfaces, const Execution& execution)
    : tree_(std::make_unique<RayTree>(make_tree(surfaces, execution))) {}
RayIndex::RayIndex(const Scene& scene, const Execution& execution)
    : tree_(std::make_unique<RayTree>(make_placed_tree(scene, execution))) {}
RayIndex::~RayIndex() = default;
RayIndex::RayIndex(RayIndex&&) noexcept = default;
RayIndex& RayIndex::operator=(RayIndex&&) noexcept = default;

void RayIndex::refit(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  report_progress(execution, "index", 0);
  if (!refit_tree(surfaces, *tree_, execution)) *tree_ = make_tree(surfaces, execution);
  report_progress(execution, "index", 1);
}

void RayIndex::refit(const Scene& scene, const Execution& execution) {
  const IeeeScope ieee;
  if (!replace_instances(scene, *tree_, execution)) *tree_ = make_placed_tree(scene, execution);
}

std::uint32_t RayIndex::triangle_count() const { return tree_->triangle_count; }

const Box& RayIndex::bounds() const { return tree_->bounds; }

std::size_t RayIndex::byte_count() const {
  return sizeof(RayTree) + tree_->nodes.size() * sizeof(RayNode) + tree_->leaves.size() * sizeof(RayLeaf) +
         tree_->placed.size() * sizeof(PlacedRoot) + (tree_->cutouts ? tree_->cutouts->byte_count() : 0);
}

}  // namespace frontmost
