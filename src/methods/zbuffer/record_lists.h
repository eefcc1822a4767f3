// SPDX-License-Identifier: Apache-2.0
// Large and clipped triangles, nearest first, and the tiles in which each may be seen.
//
//    records    nearest first
//    round 0    tiles 0 ... 40      lists of at most 2^26 items together
//    round 1    tiles 41 ... 90     made when round 0 is drawn, in the same memory
//
// A large triangle is in many tiles, so its lists could grow without bound. Lists are therefore made round by round.
#pragma once

#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "zbuffer/tile/tile_lists.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// The most items that the lists of one round hold (256 MiB), unless a single tile has more.
inline constexpr std::size_t kMostRecordItems = std::size_t(1) << 26;

/// Records and their tile lists. Planning the next frame reuses the memory.
class RecordLists {
 public:
  /// Filled by the caller before plan(); vertices from the image's top left.
  std::vector<TriangleRecord> records;

  /// Sorts the records nearest first, cutouts behind all others, and finds the rounds. Among solid records with the
  /// same vertices plan() keeps only the lowest id.
  void plan(const View& view, const Cutouts* cutouts, std::size_t most_items = kMostRecordItems);
  /// The rounds in which tiles are drawn. An ordinary scene takes one round; a million triangles that each fill the
  /// largest image make 16 thousand million pairs of record and tile.
  [[nodiscard]] std::span<const TileRange> rounds() const { return rounds_; }
  /// Lists the records that may be seen in each tile of a round, and drops the lists of the round before.
  void list(const TileRange& round, const View& view);
  /// Precondition: `tile` belongs to the round listed last.
  [[nodiscard]] PartedList of(std::size_t tile) const {
    return {lists_.of(tile), [&](std::uint32_t i) { return i >= first_cutout_; }};
  }

 private:
  void split_into_rounds(const View& view, std::size_t most_items);

  std::size_t first_cutout_ = 0;
  TileLists lists_;
  std::vector<TileRange> rounds_;
};

/// Calls draw(tile, scratch) for every tile once its records are listed; many tiles are drawn at the same time.
template <class Draw>
void draw_tiles(RecordLists& records, const View& view, const Execution& execution, Pool<TileScratch>& scratches,
                const Draw& draw) {
  for (const TileRange& round : records.rounds()) {
    records.list(round, view);
    parallel_for(execution, round.end - round.begin, 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches.borrow([] { return std::make_unique<TileScratch>(); });
      scratch->reserve(std::size_t(view.samples));
      for (std::size_t tile = round.begin + begin; tile < round.begin + end; ++tile) draw(tile, *scratch);
    });
  }
}

/// Calls add(tile) for the tiles of `range` in which a record may be seen; vertices from the image's top left.
template <class Add>
void visit_tiles(const TriangleRecord& record, const View& view, const TileRange& range, const Add& add) {
  const PixelRect rect = pixel_rect(record, view.width, view.height);
  if (rect.is_empty()) return;
  const TileRect tiles(rect);
  const std::size_t across = Tile::tiles_across(view);
  const int first_row = int(range.begin / across), last_row = int((range.end - 1) / across);
  for (int y = std::max(tiles.y0, first_row); y <= std::min(tiles.y1, last_row); ++y)
    for (int x = tiles.x0; x <= tiles.x1; ++x) {
      const std::size_t tile = std::size_t(y) * across + std::size_t(x);
      if (tile < range.begin || tile >= range.end) continue;
      const PixelRect pixels{x * kTileSize, y * kTileSize, (x + 1) * kTileSize - 1, (y + 1) * kTileSize - 1};
      // With a single tile, pixel_rect() has already tested the outermost coordinates. A long diagonal triangle touches
      // few tiles of its rectangle.
      if (tiles.count() == 1 || !misses(record, pixels)) add(tile);
    }
}

}  // namespace frontmost::zbuffer_detail
