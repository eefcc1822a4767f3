// SPDX-License-Identifier: Apache-2.0
// Updates an index after one instance has moved: its triangles get their new places, and the boxes from there to the
// root are fitted anew.
//
//    leaves that hold triangles of the instance --> boxes of these leaves --> nodes above

#include <algorithm>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {
namespace {

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
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][link % kRayLanes] = box.low[axis];
      node.high[axis][link % kRayLanes] = box.high[axis];
    }
    box = box_of(node);
  }
  tree.bounds = box;
}

/// Moves an instance's triangles in a leaf. \returns how many, or no_index if a triangle is not finite any more.
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

/// The triangles of a mesh with finite vertices, no two of which are the same.
std::uint32_t count_met(const Mesh& mesh) {
  std::uint32_t count = 0;
  for (const glm::uvec3& c : mesh.triangles) {
    const glm::vec3 &p = mesh.positions[c.x], &q = mesh.positions[c.y], &r = mesh.positions[c.z];
    count += is_finite(p) && is_finite(q) && is_finite(r) && !has_same_bits(p, q) && !has_same_bits(q, r) &&
             !has_same_bits(r, p);
  }
  return count;
}

bool move_instance(const PlacedScene& placed, std::uint32_t instance, RayTree& tree) {
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
    fit_above(tree, leaf, as_box(box_of(tree.leaves[leaf], leaf)));
  }
  // The counts differ if vertices became finite.
  return count == count_met(placed.scene->meshes[placed.scene->instances[instance].mesh]);
}

}  // namespace

bool follow_instance(const Surfaces& surfaces, std::uint32_t instance, RayTree& tree) {
  const PlacedScene& placed = placed_scene(surfaces);
  TreeChange change(tree);
  tree.cutouts = placed.cutouts;
  tree.sides = placed.sides;
  if (!move_instance(placed, instance, tree)) return false;
  change.complete();
  return true;
}

}  // namespace frontmost
