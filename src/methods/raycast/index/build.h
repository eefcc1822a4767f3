// SPDX-License-Identifier: Apache-2.0
// How a RayTree is made and moved:
//
//   Surfaces --fill_leaves--> leaves --take_copies--> group_leaves --> boxes of leaves --build_nodes--> nodes
//                                      (copies have a tree of their own)
//   moved Surfaces --refit_tree--> the same leaves and nodes, with new corners and boxes
#pragma once

#include <vector>

#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// While a tree is changed in place. Where an error ends that halfway it holds triangles of two scenes, and holes of
/// one: nothing is left of it then.
class TreeChange {
 public:
  explicit TreeChange(RayTree& tree) : tree_(tree) {}
  ~TreeChange() {
    if (!is_complete_) tree_ = RayTree();
  }
  TreeChange(const TreeChange&) = delete;
  TreeChange& operator=(const TreeChange&) = delete;
  void complete() { is_complete_ = true; }

 private:
  RayTree& tree_;
  bool is_complete_ = false;
};

/// Bounds of leaves, to build nodes over.
struct LeafBox {
  float low[3];
  std::uint32_t leaf;
  float high[3];
  std::uint32_t unused;
};
[[nodiscard]] inline Box as_box(const LeafBox& b) {
  return {{b.low[0], b.low[1], b.low[2]}, {b.high[0], b.high[1], b.high[2]}};
}

/// Fills tree.leaves in the surfaces' spatial order.
void fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution);

/// Where thousands of triangles are those before them once more, as of objects that are placed a million times in one
/// place, moves them to a tree of their own, whose leaves alone are filled. Leaves of `tree` are in the surfaces'
/// spatial order, in which copies follow each other. \returns null, and leaves all as it is, where there are few.
[[nodiscard]] std::shared_ptr<RayTree> take_copies(RayTree& tree, const Execution& execution);

/// Deals the triangles out anew, a few leaves at a time, so that leaves are small. \returns the box of every leaf.
[[nodiscard]] std::vector<LeafBox> group_leaves(RayTree& tree, const Execution& execution);

/// Moves the triangles of `tree` to where they are in `surfaces`, and fits every box anew.
/// \returns false where `surfaces` has other triangles; the tree is then empty, as it is after an error.
[[nodiscard]] bool refit_tree(const Surfaces& surfaces, RayTree& tree, const Execution& execution);

/// The bounds of the triangles in use.
[[nodiscard]] LeafBox box_of(const RayLeaf& leaf, std::uint32_t number);

/// Those of a node's children.
[[nodiscard]] inline Box box_of(const RayNode& node) {
  Box box;
  for (std::size_t lane = 0; lane < node.count; ++lane)
    box.include(Box{{node.low[0][lane], node.low[1][lane], node.low[2][lane]},
                    {node.high[0][lane], node.high[1][lane], node.high[2][lane]}});
  return box;
}

/// Fills tree.nodes over the boxes, which are reordered.
void build_nodes(std::vector<LeafBox>& boxes, RayTree& tree, const Execution& execution);

/// Moves one instance to where it is in `surfaces`, which are those that the tree is of. \returns false where the tree
/// has to be made anew, because corners have become finite, are so no more, or are copies of others; it is then empty,
/// as it is after an error.
[[nodiscard]] bool follow_instance(const Surfaces& surfaces, std::uint32_t instance, RayTree& tree);

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
