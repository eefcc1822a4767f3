// SPDX-License-Identifier: Apache-2.0
// The data of RayIndex: nodes of eight boxes, leaves of eight triangles, as structure of arrays.
//
//    node   low x   [ . . . . . . . . ]       One vector of AVX2 or AVX-512 tests all eight boxes or triangles at once;
//           low y   [ ................ ]       narrower instruction sets take fewer in turn, and give the same bits.
//           ...
//           child   [ leaf | node ... ]
//
// Wide nodes make few levels between the root and a leaf, and a walk waits for memory once a level. Unused lanes hold
// zeros and come last.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/memory.h"
#include "frontmost/raycast.h"
#include "surfaces/cluster_set.h"
#include "surfaces/cutouts.h"
#include "surfaces/groups_by_instance.h"
#include "surfaces/material_sides.h"

namespace frontmost {

/// Boxes or triangles side by side. On AVX2, single rays are 1.6 times and views 0.9 to 1.45 times as fast as with
/// sixteen. AVX-512 was not measured.
inline constexpr std::size_t kRayLanes = 8;

/// A child is the index of a leaf, with this bit set, or the index of a node.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;

/// World-space boxes of `count` children. Unused lanes hold zeros.
struct alignas(64) RayNode {
  float low[3][kRayLanes], high[3][kRayLanes];
  std::uint32_t child[kRayLanes];
  std::uint32_t count;

  /// low and high as one array of floats.
  [[nodiscard]] const float* bounds() const { return &low[0][0]; }
  void set_box(std::size_t lane, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis][lane] = box.low[axis];
      high[axis][lane] = box.high[axis];
    }
  }
};

/// corner[k][axis][lane], world space, counter-clockwise seen from the front. Unused lanes come last, hold zeros, and
/// have the id no_primitive.
struct alignas(64) RayLeaf {
  float corner[3][3][kRayLanes];
  PrimitiveId id[kRayLanes];

  [[nodiscard]] std::array<glm::vec3, 3> corners_of(std::size_t lane) const {
    std::array<glm::vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]};
    return corners;
  }
  /// Copies a triangle from a lane of another leaf.
  void copy(std::size_t lane, const RayLeaf& from, std::size_t from_lane) {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) corner[k][axis][lane] = from.corner[k][axis][from_lane];
    id[lane] = from.id[from_lane];
  }
};

/// Links from children to parents, for instances that move. A link is node * kRayLanes + lane, or no_index at the root.
struct RayLinks {
  std::vector<std::uint32_t> above_node;
  std::vector<std::uint32_t> above_leaf;
  std::optional<Buckets<std::uint32_t>> leaves_of_instances;  ///< groups_by_instance()
};

struct RayTree {
  Buffer<RayNode> nodes;
  Buffer<RayLeaf> leaves;
  std::uint32_t root = no_index;  ///< a child; no_index when there are no triangles
  std::uint32_t triangle_count = 0;
  std::uint32_t depth = 0;                 ///< nodes from the root to the deepest leaf
  Box bounds;                              ///< around the triangles
  glm::vec3 reach{0};                      ///< the bounds' greatest distances from zero along each axis
  std::shared_ptr<const Cutouts> cutouts;  ///< null if no triangle has holes
  std::shared_ptr<const MaterialSides> sides;
  /// A second tree, which holds the copies that were removed from this tree. Each copy has the vertices of a triangle
  /// of this tree, in the same order, and a higher id. Queries for the nearest hit, or for any hit, do not need the
  /// copies. Null if no copies were removed.
  std::shared_ptr<RayTree> copies;
  std::optional<RayLinks> links;  ///< made when first needed

  [[nodiscard]] const RayLeaf& leaf(std::uint32_t child) const { return leaves[child & ~kLeafBit]; }
  /// Prefetches a child that will be visited soon. No branch depends on the child, as it would often be mispredicted.
  void prefetch(std::uint32_t child) const {
    const std::uint32_t is_leaf = child >> 31, size = sizeof(RayNode) + is_leaf * (sizeof(RayLeaf) - sizeof(RayNode));
    const char* const bases[] = {reinterpret_cast<const char*>(nodes.data()),
                                 reinterpret_cast<const char*>(leaves.data())};
    const char* const from = bases[is_leaf] + std::size_t(child & ~kLeafBit) * size;
    for (std::size_t i = 0; i < sizeof(RayNode); i += 64) prefetch_line(from + i);
    prefetch_line(from + size - 64);
  }

  void set_bounds(const Box& box) {
    bounds = box;
    reach = glm::max(glm::abs(box.low), glm::abs(box.high));
  }

  /// The most children that wait at once in a depth-first walk.
  [[nodiscard]] std::size_t stack_size() const { return std::size_t(depth) * (kRayLanes - 1) + 1; }
};

/// The tree that an index holds.
[[nodiscard]] const RayTree& ray_tree(const RayIndex& index);

// Building a tree, and moving it.

/// The bounds of the leaf's triangles; unused lanes do not count.
[[nodiscard]] Box box_of(const RayLeaf& leaf);

/// Makes the tree of the surfaces.
[[nodiscard]] RayTree make_tree(const Surfaces& surfaces, const Execution& execution);

/// Calls visit(t) for the triangles of a cluster of which no two vertices are the same. No ray meets another one;
/// Surfaces makes vertices the same to mark a triangle that is not finite.
template <class Visit>
void visit_triangles(const ClusterSet& set, const Cluster& cluster, const Visit& visit) {
  for (std::size_t t = cluster.first_triangle; t < cluster.first_triangle + cluster.triangle_count; ++t)
    if (set.i0[t] != set.i1[t] && set.i1[t] != set.i2[t] && set.i2[t] != set.i0[t]) visit(t);
}

/// Sets the vertices of triangle `t` of a cluster in a lane.
inline void set_corners(const ClusterSet& set, const Cluster& cluster, std::size_t t, RayLeaf& leaf, std::size_t lane) {
  const std::size_t corners[3] = {set.i0[t], set.i1[t], set.i2[t]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = cluster.first_vertex + corners[k];
    leaf.corner[k][0][lane] = set.x[v];
    leaf.corner[k][1][lane] = set.y[v];
    leaf.corner[k][2][lane] = set.z[v];
  }
}

}  // namespace frontmost
