// SPDX-License-Identifier: Apache-2.0
// Large and clipped triangles, nearest first, and in which tiles they may be seen.
#pragma once

#include <vector>

#include "zbuffer/tile/tile_lists.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// The most items that the lists of one round hold (256 MiB), unless a single tile has more.
inline constexpr std::size_t kMostRecordItems = std::size_t(1) << 26;

/// Planning the next ones reuses their memory.
class RecordLists {
 public:
  /// To be filled before plan(): corners from the image's top left.
  std::vector<TriangleRecord> records;

  /// Sorts the records, nearest first, keeps the lowest id of those with the same corners, and finds the rounds.
  /// Precondition: none has holes.
  void plan(const View& view, std::size_t most_items = kMostRecordItems);
  /// Tiles are drawn in rounds: one for any ordinary scene, but a million triangles that each fill the largest image
  /// make 16 thousand million pairs of record and tile.
  [[nodiscard]] std::span<const TileRange> rounds() const { return rounds_; }
  /// Lists the records that may be seen in each tile of a round, in place of those of the round before.
  void list(const TileRange& round, const View& view);
  /// Precondition: `tile` is of the round listed last.
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const { return lists_.of(tile); }

 private:
  void split_into_rounds(const View& view, std::size_t most_items);

  TileLists lists_;
  std::vector<TileRange> rounds_;
};

}  // namespace frontmost::zbuffer_detail
