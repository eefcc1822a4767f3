// SPDX-License-Identifier: Apache-2.0
// Boxes on the screen: the cells that they reach at most, and their nearest distance.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "occlusion/cover.h"
#include "view/screen_transform.h"

namespace frontmost::occlusion_detail {

/// The screen, divided into cells.
struct CellGrid {
  ScreenTransform transform;
  int columns, rows;
  float cells_per_unit;  ///< for 1/256 pixel
  float margin;          ///< in cells: more than snapping and rounding move a vertex

  CellGrid(const View& view, int cell);
};

/// Consecutive numbers.
struct ItemRange {
  std::uint32_t first = 0, count = 0;
  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// Boxes as structure of arrays. Empty boxes pad the arrays to whole vectors.
struct BoxColumns {
  static constexpr std::size_t most_lanes = 16;
  std::array<std::vector<float>, 3> low, high;

  explicit BoxColumns(std::size_t count);
  /// Precondition: empty or finite.
  void set(std::size_t number, const Box& box);
  [[nodiscard]] Box get(std::size_t number) const;
  [[nodiscard]] bool is_empty(std::size_t number) const { return low[0][number] > high[0][number]; }
};

/// The place of a box on the screen.
struct ScreenBox {
  CellRect rect;   ///< empty if the box is empty or outside of the viewing volume
  float nearest;   ///< planar distance; -infinity if the box reaches before the near plane
  float farthest;  ///< greatest planar distance
};

/// Puts boxes on the screen, rounded outwards everywhere. `out` is indexed by number of box.
void find_on_screen(const CellGrid& grid, const BoxColumns& boxes, const ItemRange& which, std::vector<ScreenBox>& out,
                    Isa isa);

/// Whether nearer triangles than a distance cover all cells of a rectangle within the screen.
using CoverTest = bool (*)(const CellCover& cover, const CellRect& rect, float distance);
[[nodiscard]] CoverTest cover_test(Isa isa);

/// The sights of boxes, one each.
void find_sights_of(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights, Isa isa);

}  // namespace frontmost::occlusion_detail
