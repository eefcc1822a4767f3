// SPDX-License-Identifier: Apache-2.0
// Building and moving a RayTree:
//
//   Surfaces --fill_leaves--> leaves --take_copies--> group_leaves --> boxes of leaves --build_nodes--> nodes
//                                      (copies have a tree of their own)
//   moved Surfaces --refit_tree--> the same leaves and nodes, with new corners and boxes
#pragma once

#include <vector>

#include "raycast/index/ray_tree.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// Guards a tree while it is changed in place. An error halfway would leave triangles of two scenes, and holes of one;
/// the destructor then empties the tree.
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

/// Fills tree.leaves in the surfaces' spatial order.
void fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution);

/// Moves copies of triangles to a tree of their own, of which only the leaves are filled, if thousands of triangles
/// repeat the ones before them, as objects placed a million times in one place do. Leaves of `tree` are in the
/// surfaces' spatial order, in which copies follow each other. \returns null, and changes nothing, if there are few
/// copies.
[[nodiscard]] std::shared_ptr<RayTree> take_copies(RayTree& tree, const Execution& execution);

/// Redistributes triangles within a few leaves at a time, so that leaves get small. \returns the box of every leaf.
[[nodiscard]] std::vector<LeafBox> group_leaves(RayTree& tree, const Execution& execution);

/// Moves the triangles of `tree` to their places in `surfaces`, and fits every box anew. \returns false if `surfaces`
/// has other triangles; the tree is then empty, as after an error.
[[nodiscard]] bool refit_tree(const Surfaces& surfaces, RayTree& tree, const Execution& execution);

/// The bounds of the leaf's triangles; unused lanes do not count.
[[nodiscard]] LeafBox box_of(const RayLeaf& leaf, std::uint32_t number);

/// The bounds of a node's children.
[[nodiscard]] inline Box box_of(const RayNode& node) {
  Box box;
  for (std::size_t lane = 0; lane < node.count; ++lane)
    box.include(Box{{node.low[0][lane], node.low[1][lane], node.low[2][lane]},
                    {node.high[0][lane], node.high[1][lane], node.high[2][lane]}});
  return box;
}

/// Fills tree.nodes over the boxes, and reorders the boxes.
void build_nodes(std::vector<LeafBox>& boxes, RayTree& tree, const Execution& execution);

/// Moves one instance to its place in `surfaces`, from which the tree was made. \returns false if the tree must be made
/// anew, because vertices became finite or ceased to be, or because triangles are copies of others. The tree is then
/// empty, as after an error.
[[nodiscard]] bool follow_instance(const Surfaces& surfaces, std::uint32_t instance, RayTree& tree);

/// Whether two vertices are the same. No ray meets such a triangle; Surfaces makes vertices the same to mark a triangle
/// that is not finite.
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
