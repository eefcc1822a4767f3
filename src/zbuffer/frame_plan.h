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

/// The plan of a frame. Planning the next one reuses its memory.
class FramePlan {
 public:
  /// Culls, takes apart what must be, orders and bins. O(clusters + pairs of large triangle and tile) time. Memory:
  /// about 30 bytes a cluster and 64 for one drawn whole, 100 a large or clipped triangle, and the lists of one round.
  void make(const ClusterSet& set, const ScreenTransform& transform, const View& view, const Execution& execution,
            std::size_t most_record_items = kMostRecordItems);

  [[nodiscard]] std::size_t tile_count() const { return std::size_t(tiles_x_) * std::size_t(tiles_y_); }
  [[nodiscard]] const CullResult& culled() const { return culled_; }
  /// Corners from the image's top left; nearest first.
  [[nodiscard]] std::span<const TriangleRecord> records() const { return records_; }
  /// Tiles are drawn in rounds: one for any ordinary scene, but a million triangles that each fill the largest image
  /// make 16 thousand million pairs of record and tile.
  [[nodiscard]] std::span<const TileRange> rounds() const { return rounds_; }

  /// Lists the records that may be seen in each tile of a round, in place of those of the round before.
  void list_records(const TileRange& round, const View& view);
  /// Precondition: `tile` is of the round listed last.
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;

 private:
  void choose_apart(std::size_t cluster_count);
  void take_apart(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                  const Execution& execution);
  void split_into_rounds(const View& view, std::size_t most_items);
  void order_whole(std::size_t cluster_count);
  void list_clusters();

  int tiles_x_ = 0, tiles_y_ = 0;
  CullResult culled_;
  std::vector<std::uint32_t> apart_;                      // clusters to be taken apart
  std::vector<std::vector<TriangleRecord>> apart_parts_;  // what threads made of them
  std::vector<TriangleRecord> records_;
  std::vector<std::uint32_t> order_;  // clusters drawn whole, nearer slices first
  TileLists cluster_lists_, record_lists_;
  std::vector<TileRange> rounds_;
};

}  // namespace frontmost::zbuffer_detail
