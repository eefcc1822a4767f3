// SPDX-License-Identifier: Apache-2.0
// Drawing one tile of the picture: the inner loop of the z-buffer.
#pragma once

#include <span>

#include "surfaces/cluster_set.h"
#include "zbuffer/cull.h"
#include "zbuffer/tile/tile.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// What all tiles of a frame have in common. Borrows everything.
struct FrameInput : Picture {
  const ClusterSet& set;
  const ScreenTransform& transform;
  const CullResult& culled;
  std::span<const TriangleRecord> records;  ///< corners from the image's top left
};

/// One tile, and what may be seen in it, near things first.
struct TileJob : Tile {
  std::span<const std::uint32_t> records, clusters;

  [[nodiscard]] bool is_empty() const { return records.empty() && clusters.empty(); }
};

/// Draws a tile and writes it to the output planes.
void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
