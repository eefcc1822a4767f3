// SPDX-License-Identifier: Apache-2.0
// Trees of meshes, brought into the world where a walk comes to them: boxes with room for rounding, triangles to the
// bit as Surfaces places them. Inlined into kernels, so that each instruction set has its own.
//
//    mesh space                world space              A box of a mesh is placed by the interval arithmetic of its
//     +-----+                   .--------.              matrix, and padded by more than the roundings of any corner
//     |     |   world_from_mesh |  /  \  |              within it. So a placed box always holds the placed triangles,
//     +-----+   ------------->  |  \  /  |              whose corners have the very bits that Surfaces gives them.
//                               '--------'
#pragma once

#include <cmath>
#include <limits>

#include "base/memory.h"
#include "hwy/base.h"
#include "raycast/index/ray_tree.h"

namespace frontmost::raycast_detail {

/// Around every position that a box of `from` can be placed at. Boxes within each other stay so.
HWY_INLINE void place(const PlacedRoot& by, const RayNode& from, RayNode& to) {
  constexpr auto least = std::numeric_limits<float>::min();
  for (int row = 0; row < 3; ++row) {
    float low[kRayLanes], high[kRayLanes], size[kRayLanes];
    const float offset = float(by.world_from_mesh[3][row]);
    for (std::size_t i = 0; i < kRayLanes; ++i) low[i] = high[i] = offset, size[i] = std::abs(offset) + least;
    for (int axis = 0; axis < 3; ++axis) {
      const float m = float(by.world_from_mesh[axis][row]);
      const float* const a = m >= 0 ? from.low[axis] : from.high[axis];
      const float* const b = m >= 0 ? from.high[axis] : from.low[axis];
      // Factors below the normal floats have fewer digits.
      const float reach = std::abs(m) + least;
      for (std::size_t i = 0; i < kRayLanes; ++i) {
        low[i] += m * a[i];
        high[i] += m * b[i];
        const float far_a = std::abs(a[i]), far_b = std::abs(b[i]);
        size[i] += reach * (far_a > far_b ? far_a : far_b);
      }
    }
    // Five roundings of sums up to `size`, the corner's own, and as much again.
    for (std::size_t i = 0; i < kRayLanes; ++i) {
      const float pad = 0x1p-20f * size[i];
      to.low[row][i] = low[i] - pad;
      to.high[row][i] = high[i] + pad;
    }
  }
  for (std::size_t i = 0; i < kRayLanes; ++i) to.child[i] = from.child[i];
  to.count = from.count;
}

/// As to_world() does. Triangles that leave the floats go.
HWY_INLINE void place(const PlacedRoot& by, const RayLeaf& from, RayLeaf& to) {
  for (std::size_t i = 0; i < kRayLanes; ++i)
    to.id[i] = from.id[i] == no_primitive ? no_primitive : from.id[i] + by.first;
  float nothing[kRayLanes] = {};
  for (std::size_t k = 0; k < 3; ++k) {
    // Mirroring turns the winding; Surfaces swaps the last two corners, and ids and bits are to be the same.
    const auto& corner = from.corner[by.is_mirrored && k > 0 ? 3 - k : k];
    for (int row = 0; row < 3; ++row) {
      const glm::dmat4& m = by.world_from_mesh;
      const double m0 = m[0][row], m1 = m[1][row], m2 = m[2][row], m3 = m[3][row];
      float* const placed = to.corner[k][row];
      for (std::size_t i = 0; i < kRayLanes; ++i) {
        placed[i] = float(m0 * double(corner[0][i]) + m1 * double(corner[1][i]) + m2 * double(corner[2][i]) + m3);
        nothing[i] += placed[i] - placed[i];
      }
    }
  }
  for (std::size_t i = 0; i < kRayLanes; ++i) {
    if (HWY_LIKELY(nothing[i] == 0)) continue;
    to.id[i] = no_primitive;
    for (auto& corner : to.corner)
      for (auto& axis : corner) axis[i] = 0;
  }
}

/// A walk over one level or two: the tree that it is in, and nodes and leaves as they stand in the world.
class PlacedWalk {
 public:
  explicit PlacedWalk(const RayTree& tree) : tree_(tree), has_instances_(!tree.placed.empty()) {}

  /// For every child that is taken, with the number of those that still wait: an instance ends where its children do.
  HWY_INLINE void Take(std::size_t waiting) {
    if (waiting >= floor_) return;
    floor_ = 0;
    placed_ = nullptr;
  }
  [[nodiscard]] HWY_INLINE bool IsInstance(std::uint32_t child) const {
    return has_instances_ && placed_ == nullptr && (child & kLeafBit) != 0;
  }
  /// Into the instance that was taken. \returns the child to go on with, above `waiting` others.
  HWY_INLINE std::uint32_t Enter(std::uint32_t child, std::size_t waiting) {
    placed_ = &tree_.placed[child & ~kLeafBit];
    is_moved_ = placed_->world_from_mesh != glm::dmat4(1.0);
    floor_ = waiting;
    return placed_->root;
  }
  /// What `waiting` counts belongs to the tree around this one.
  [[nodiscard]] HWY_INLINE bool IsAround(std::size_t waiting) const { return waiting <= floor_; }

  /// For a child that will be taken soon, and that is not around this tree.
  HWY_INLINE void Prefetch(std::uint32_t child) const {
    if (IsInstance(child)) return;
    const char* const from = child & kLeafBit ? reinterpret_cast<const char*>(&tree_.leaves[child & ~kLeafBit])
                                              : reinterpret_cast<const char*>(&tree_.nodes[child]);
    const std::size_t bytes = child & kLeafBit ? sizeof(RayLeaf) : sizeof(RayNode);
    for (std::size_t i = 0; i < bytes; i += 64) prefetch_line(from + i);
  }

  /// Both stay until the next call.
  [[nodiscard]] HWY_INLINE const RayNode& Node(std::uint32_t child) {
    const RayNode& node = tree_.nodes[child];
    if (HWY_LIKELY(placed_ == nullptr || !is_moved_)) return node;
    place(*placed_, node, node_);
    return node_;
  }
  [[nodiscard]] HWY_INLINE const RayLeaf& Leaf(std::uint32_t child) {
    const RayLeaf& leaf = tree_.leaves[child & ~kLeafBit];
    if (HWY_LIKELY(placed_ == nullptr)) return leaf;
    place(*placed_, leaf, leaf_);
    return leaf_;
  }

 private:
  const RayTree& tree_;
  const bool has_instances_;
  const PlacedRoot* placed_ = nullptr;
  bool is_moved_ = false;
  std::size_t floor_ = 0;
  RayNode node_;
  RayLeaf leaf_;
};

}  // namespace frontmost::raycast_detail
