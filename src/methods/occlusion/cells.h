// SPDX-License-Identifier: Apache-2.0
// Cells of the screen: which of them are covered, how far away their cover is at most, and which cells boxes reach.
//
//    tile    32 x 16 cells, a bit each: row r of a tile is rows(tile)[r], its leftmost cell the lowest bit
//    depth   of a tile: everything that covers one of its cells lies nearer
//
// Coordinates are in cells from the screen's top left corner.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "view/screen_transform.h"

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

/// The screen, divided into cells.
struct CellGrid {
  ScreenTransform transform;
  int columns, rows;
  float cells_per_unit;  ///< cells in 1/256 pixel
  float margin;          ///< in cells; greater than the distance that snapping and rounding move a vertex

  CellGrid(const View& view, int cell)
      : transform(view),
        columns((view.width + cell - 1) / cell),
        rows((view.height + cell - 1) / cell),
        cells_per_unit(1.0f / (float(kSubPixels) * float(cell))),
        margin(2.0f * cells_per_unit) {}
};

/// Consecutive items, from `first` on.
struct ItemRange {
  std::uint32_t first = 0, count = 0;
  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// Boxes as structure of arrays. Empty boxes pad the arrays to whole vectors.
struct BoxColumns {
  static constexpr std::size_t most_lanes = 16;
  std::array<std::vector<float>, 3> low, high;

  explicit BoxColumns(std::size_t count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis].resize(count + most_lanes, 1.0f);
      high[axis].resize(count + most_lanes, -1.0f);
    }
  }
  /// Precondition: the box is empty or finite.
  void set(std::size_t number, const Box& box) {
    const bool is_empty = box.is_empty();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis][number] = is_empty ? 1.0f : box.low[int(axis)];
      high[axis][number] = is_empty ? -1.0f : box.high[int(axis)];
    }
  }
  [[nodiscard]] Box get(std::size_t number) const {
    return {{low[0][number], low[1][number], low[2][number]}, {high[0][number], high[1][number], high[2][number]}};
  }
  [[nodiscard]] bool is_empty(std::size_t number) const { return low[0][number] > high[0][number]; }
};

/// The place of a box on the screen.
struct ScreenBox {
  CellRect rect;   ///< empty if the box is empty or outside of the viewing volume
  float nearest;   ///< planar distance; -infinity if the box reaches nearer than the near plane
  float farthest;  ///< greatest planar distance
};

/// Puts boxes on the screen, rounded outwards everywhere. `out` is indexed by number of box.
void find_on_screen(const CellGrid& grid, const BoxColumns& boxes, const ItemRange& which, std::vector<ScreenBox>& out,
                    Isa isa);

/// Returns whether triangles nearer than a distance cover all cells of a rectangle within the screen.
using CoverTest = bool (*)(const CellCover& cover, const CellRect& rect, float distance);
[[nodiscard]] CoverTest cover_test(Isa isa);

/// Stores the sight of each box.
void find_sights_of(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights, Isa isa);

}  // namespace frontmost::occlusion_detail
