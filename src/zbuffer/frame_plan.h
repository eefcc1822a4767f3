// SPDX-License-Identifier: Apache-2.0
// What is drawn where: the work of one frame, sorted into tiles.
#pragma once

#include <vector>

#include "zbuffer/cull.h"
#include "zbuffer/tile_kernel.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// For every tile a list of indices, one after another in one array.
struct TileLists {
  std::vector<std::uint32_t> begin;  ///< by tile, and the end of the last
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const {
    return std::span(items).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
};

struct FramePlan {
  CullResult culled;
  std::vector<TriangleRecord> records;  ///< corners from the image's top left; nearest first
  TileLists record_lists, cluster_lists;
  int tiles_x = 0, tiles_y = 0;

  [[nodiscard]] std::size_t tile_count() const { return std::size_t(tiles_x) * std::size_t(tiles_y); }
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;
};

/// Culls, takes apart what must be, orders and bins. O(clusters + large triangles).
[[nodiscard]] FramePlan plan_frame(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                                   const Execution& execution);

}  // namespace frontmost::zbuffer_detail
