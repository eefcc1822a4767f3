// SPDX-License-Identifier: Apache-2.0
// Pictures by rays: casting the rays of one tile together, and those on that went into a hole.
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

/// All tiles' input, and where the answer goes.
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

/// A child waiting to be looked into: the bits of its nearest key above its number, so that greater is nearer.
using Waiting = std::uint64_t;

/// Buffers of one thread.
struct RayTileScratch {
  static constexpr std::size_t kPixels = std::size_t(kTileSize) * kTileSize;

  void reserve(const RayTree& tree) { stack.resize(std::max(stack.size(), tree.stack_size() + kRayLanes)); }

  // Blocks of 4 x 4 pixels, row by row, and within a block its pixels row by row.
  alignas(64) float keys[kPixels];
  alignas(64) PrimitiveId ids[kPixels];
  alignas(64) float farthest[kPixels / 16];  ///< of each block
  std::vector<Waiting> stack;
};

/// Fills the pixels of tile (x, y), counted in tiles, of every sample plane.
void cast_tile(const RayTileInput& frame, int x, int y, RayTileScratch& scratch, Isa isa);

/// Of a Visible that takes triangles with holes for whole: replaces what has a hole at its sample by what the ray meets
/// next. O(samples), and O(log n) and more for each ray that goes on.
void pass_holes(const RayTree& tree, Visible& visible, const Execution& execution);

}  // namespace frontmost::raycast_detail
