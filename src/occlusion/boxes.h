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

/// Boxes as structure of arrays. The arrays are longer than `count`, by finite boxes that mean nothing.
struct BoxColumns {
  static constexpr std::size_t most_lanes = 16;
  std::size_t count = 0;
  std::array<std::vector<float>, 3> low, high;

  explicit BoxColumns(std::size_t its_count);
  /// Precondition: not empty, and finite.
  void set(std::size_t number, const Box& box);
};

/// Where a box is on the screen.
struct ScreenBox {
  CellRect rect;   ///< empty: outside of the viewing volume
  float nearest;   ///< planar distance; -infinity of boxes that reach before the near plane
  float farthest;  ///< likewise
};

/// Puts boxes on the screen, rounded outwards everywhere; `out` has as many as `boxes`.
void find_on_screen(const CellGrid& grid, const BoxColumns& boxes, std::vector<ScreenBox>& out, Isa isa);

/// Whether all cells of a rectangle within the screen are covered by what lies nearer than a distance.
using CoverTest = bool (*)(const CellCover& cover, const CellRect& rect, float distance);
[[nodiscard]] CoverTest cover_test(Isa isa);

/// What is known of many boxes, of which there are as many sights.
void find_sights_of(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights, Isa isa);

}  // namespace frontmost::occlusion_detail
