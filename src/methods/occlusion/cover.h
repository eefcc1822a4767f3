// SPDX-License-Identifier: Apache-2.0
// Which cells of the screen are covered, and the greatest distance of their cover.
//
//    tile    32 x 16 cells, a bit each: row r of a tile is rows(tile)[r], its leftmost cell the lowest bit
//    depth   of a tile: everything that covers one of its cells lies nearer
//
// Coordinates are in cells from the screen's top left corner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::occlusion_detail {

inline constexpr int tile_columns = 32, tile_rows = 16;

/// A half-open rectangle of cells.
struct CellRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  /// The number of tiles that the rectangle reaches into.
  [[nodiscard]] int tile_count() const {
    return ((x1 - 1) / tile_columns - x0 / tile_columns + 1) * ((y1 - 1) / tile_rows - y0 / tile_rows + 1);
  }
};

/// A bit for every cell.
class CellBits {
 public:
  /// Sets the size, and all bits to zero.
  void begin(int columns, int rows) {
    tiles_x_ = (columns + tile_columns - 1) / tile_columns;
    tiles_y_ = (rows + tile_rows - 1) / tile_rows;
    const std::size_t count = std::size_t(tile_count()) * tile_rows;
    if (rows_.size() != count) rows_ = Buffer<std::uint32_t>(count);
    std::fill(rows_.begin(), rows_.end(), 0u);
  }
  [[nodiscard]] int tiles_x() const { return tiles_x_; }
  [[nodiscard]] int tile_count() const { return tiles_x_ * tiles_y_; }
  [[nodiscard]] std::uint32_t* rows(int tile) { return rows_.data() + std::ptrdiff_t(tile) * tile_rows; }
  [[nodiscard]] const std::uint32_t* rows(int tile) const { return rows_.data() + std::ptrdiff_t(tile) * tile_rows; }

 private:
  int tiles_x_ = 0, tiles_y_ = 0;
  Buffer<std::uint32_t> rows_;
};

/// The cover so far. A tile without covered cells has the depth -infinity.
struct CellCover {
  int columns = 0, rows = 0;
  CellBits covered;
  std::vector<float> depth;  ///< by tile
  /// By tile: its depth if every cell of the tile is covered, else infinity. A few more entries fill whole vectors.
  std::vector<float> full_depth;

  void begin(int its_columns, int its_rows) {
    columns = its_columns;
    rows = its_rows;
    covered.begin(columns, rows);
    depth.assign(std::size_t(covered.tile_count()), -std::numeric_limits<float>::infinity());
    full_depth.assign(std::size_t(covered.tile_count() + tile_rows), std::numeric_limits<float>::infinity());
  }
};

}  // namespace frontmost::occlusion_detail
