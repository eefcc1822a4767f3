// SPDX-License-Identifier: Apache-2.0
// What is drawn where: the work of one frame, sorted into tiles.
#pragma once

#include <vector>

#include "zbuffer/cull.h"
#include "zbuffer/tile_kernel.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// Tiles [begin, end), counted row by row.
struct TileRange {
  std::size_t begin = 0, end = 0;
};

/// For every tile of a range a list of indices, one after another in one array.
struct TileLists {
  std::size_t first_tile = 0;
  std::vector<std::size_t> begin;  ///< by tile, and the end of the last
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const {
    const std::size_t i = tile - first_tile;
    return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

/// The most items that the record lists of one round hold (256 MiB), unless a single tile has more.
inline constexpr std::size_t kMostRecordItems = std::size_t(1) << 26;

struct FramePlan {
  CullResult culled;
  std::vector<TriangleRecord> records;  ///< corners from the image's top left; nearest first
  TileLists cluster_lists;
  int tiles_x = 0, tiles_y = 0;
  /// Tiles are drawn in rounds: one for any ordinary scene, but a million triangles that each fill the largest image
  /// make 16 thousand million pairs of record and tile.
  std::vector<TileRange> rounds;

  [[nodiscard]] std::size_t tile_count() const { return std::size_t(tiles_x) * std::size_t(tiles_y); }
  /// Lists the records that may be seen in each tile of a round.
  [[nodiscard]] TileLists record_lists(const TileRange& round, const View& view) const;
  [[nodiscard]] TileJob job(std::size_t tile, const View& view, const TileLists& record_lists) const;
};

/// Culls, takes apart what must be, orders and bins. O(clusters + pairs of large triangle and tile) time. Memory: about
/// 30 bytes a cluster and 64 for one drawn whole, 100 a large or clipped triangle, and the lists of one round.
[[nodiscard]] FramePlan plan_frame(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                                   const Execution& execution, std::size_t most_record_items = kMostRecordItems);

}  // namespace frontmost::zbuffer_detail
