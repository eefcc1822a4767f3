// SPDX-License-Identifier: Apache-2.0
// Boxes on the screen: which cells they reach at most, and how near they come.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "occlusion/cover.h"
#include "view/screen_transform.h"

namespace frontmost::occlusion_detail {

/// The screen as cells.
struct CellGrid {
  ScreenTransform transform;
  int columns, rows;
  float cells_per_unit;  ///< for 1/256 pixel
  float margin;          ///< in cells: more than what snapping and rounding move a vertex by

  CellGrid(const View& view, int cell);
};

/// Consecutive numbers.
struct ItemRange {
  std::uint32_t first = 0, count = 0;
  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// Boxes as structure of arrays, which are longer than asked for, by empty boxes.
struct BoxColumns {
  static constexpr std::size_t most_lanes = 16;
  std::array<std::vector<float>, 3> low, high;

  explicit BoxColumns(std::size_t count);
  /// Precondition: empty or finite.
  void set(std::size_t number, const Box& box);
  [[nodiscard]] Box get(std::size_t number) const;
  [[nodiscard]] bool is_empty(std::size_t number) const { return low[0][number] > high[0][number]; }
};

/// Where a box is on the screen.
struct ScreenBox {
  CellRect rect;   ///< empty: outside of the viewing volume, or an empty box
  float nearest;   ///< planar distance; -infinity of boxes that reach before the near plane
  float farthest;  ///< likewise
};

/// Puts boxes on the screen, rounded outwards everywhere; `out` is by number of box.
void find_on_screen(const CellGrid& grid, const BoxColumns& boxes, const ItemRange& which, std::vector<ScreenBox>& out,
                    Isa isa);

/// Whether all cells of a rectangle within the screen are covered by what lies nearer than a distance.
using CoverTest = bool (*)(const CellCover& cover, const CellRect& rect, float distance);
[[nodiscard]] CoverTest cover_test(Isa isa);

/// What is known of many boxes, of which there are as many sights.
void find_sights_of(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights, Isa isa);

}  // namespace frontmost::occlusion_detail
