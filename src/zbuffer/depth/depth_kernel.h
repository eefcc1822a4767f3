// SPDX-License-Identifier: Apache-2.0
// Drawing placed triangles into a depth buffer, one tile.
#pragma once

#include <span>

#include "view/screen_cutout.h"
#include "zbuffer/depth/depth_rules.h"
#include "zbuffer/place/submission.h"

namespace frontmost::zbuffer_detail {

/// The planes of a depth buffer, [sample][y][x].
struct DepthPlanes {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
  int width, height;
  std::span<const glm::ivec2> samples;
};

/// What all tiles of a draw call have in common.
struct DepthCall {
  DepthPlanes planes;
  DepthRules rules;
  PrimitiveId id_offset;
  const Cutouts* cutouts;  ///< null where no triangle has holes, through which nothing is drawn
  const ScreenRays& rays;
};

/// Draws what a batch has in a tile, one triangle after the other; touches no pixel of other tiles.
void draw_depths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch, Isa isa);

}  // namespace frontmost::zbuffer_detail
