// SPDX-License-Identifier: Apache-2.0
// Pictures by rays: casts the rays of one tile together.
//
//    boxes and leaves, nearest first --> triangles --few pixels--> queue, many at a time --+--> keys and ids
//                                            |                                             |    of the tile
//                                            +------more pixels--> blocks of the tile -----+
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "raycast/index/ray_tree.h"
#include "raycast/tile/sample_rule.h"

namespace frontmost::raycast_detail {

/// The input of all tiles, and the planes of the answer.
struct RayTileInput {
  const RayTree& tree;
  const ScreenTransform& transform;
  const View& view;
  FacingRule facing;
  std::span<const glm::ivec2> samples;
  glm::vec3 reach;  ///< the greatest |position - eye| of any triangle, by axis
  PrimitiveId* primitives;
  float* keys;
  bool streams;  ///< whole rows are written past the caches
};

/// A child that waits to be visited: the bits of its nearest key above its index. So the greater value is the nearer
/// child.
using Waiting = std::uint64_t;

/// Buffers of one thread.
struct RayTileScratch {
  static constexpr std::size_t kPixels = std::size_t(kTileSize) * kTileSize;

  void reserve(const RayTree& tree) { stack.resize(std::max(stack.size(), tree.stack_size() + kRayLanes)); }

  // Blocks of 4 x 4 pixels, row by row, and within a block its pixels row by row.
  alignas(64) float keys[kPixels];
  alignas(64) PrimitiveId ids[kPixels];
  alignas(64) float farthest[kPixels / 16];  ///< farthest key of each block
  std::vector<Waiting> stack;
};

/// Casts the rays of tile (x, y), counted in tiles, and fills its pixels in every sample plane.
void cast_tile(const RayTileInput& frame, int x, int y, RayTileScratch& scratch, Isa isa);

}  // namespace frontmost::raycast_detail
