// SPDX-License-Identifier: Apache-2.0
// A list of numbers for every tile of a range.
//
//    begin    tile 0: 0    tile 1: 3    tile 2: 3    tile 3: 7 ...
//    items    | a b c |    |            | a d e f |  ...
//
// Items are counted by tile first and then filled in their own order. So lists need no memory of their own, and sorted
// items stay sorted.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

/// Tiles [begin, end), counted row by row.
struct TileRange {
  std::size_t begin = 0, end = 0;
};

/// Tiles [x0, x1] x [y0, y1], both ends included.
struct TileRect {
  int x0, y0, x1, y1;

  explicit TileRect(const PixelRect& rect)
      : x0(rect.x0 / kTileSize), y0(rect.y0 / kTileSize), x1(rect.x1 / kTileSize), y1(rect.y1 / kTileSize) {}
  [[nodiscard]] int count() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
  [[nodiscard]] bool holds(int column, int row) const { return x0 <= column && column <= x1 && y0 <= row && row <= y1; }
};

/// Splits a list in which all cutouts stand behind the solid items.
struct PartedList {
  std::span<const std::uint32_t> solid, cutouts;

  template <class IsCutout>
  PartedList(std::span<const std::uint32_t> list, const IsCutout& is_cutout) {
    const auto first = std::partition_point(list.begin(), list.end(), [&](std::uint32_t i) { return !is_cutout(i); });
    solid = list.first(std::size_t(first - list.begin()));
    cutouts = list.subspan(solid.size());
  }
};

/// The lists stand one after another in one array.
struct TileLists {
  std::size_t first_tile = 0;
  std::vector<std::size_t> begin;  ///< first item of each tile, then the end of the last tile
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const {
    const std::size_t i = tile - first_tile;
    return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
  }
  /// Makes the lists of the tiles that `visit(item, add)` names by add(tile), items in their order.
  template <class Visit>
  void make(const TileRange& tiles, std::size_t item_count, const Visit& visit);
};

template <class Visit>
void TileLists::make(const TileRange& tiles, std::size_t item_count, const Visit& visit) {
  first_tile = tiles.begin;
  const std::size_t tile_count = tiles.end - tiles.begin;
  // Filling a list advances its beginning, so beginnings are stored one place further on at first.
  begin.assign(tile_count + 2, 0);
  for (std::size_t i = 0; i < item_count; ++i) visit(i, [&](std::size_t tile) { ++begin[tile - tiles.begin + 2]; });
  for (std::size_t tile = 0; tile < tile_count; ++tile) begin[tile + 2] += begin[tile + 1];
  items.resize(begin[tile_count + 1]);
  for (std::size_t i = 0; i < item_count; ++i)
    visit(i, [&](std::size_t tile) { items[begin[tile - tiles.begin + 1]++] = static_cast<std::uint32_t>(i); });
}

}  // namespace frontmost::zbuffer_detail
