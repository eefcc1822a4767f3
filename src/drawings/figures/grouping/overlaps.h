// SPDX-License-Identifier: Apache-2.0
// Overlaps of a figure's polygons on the screen.
//
// Each polygon is listed in the grid cells that its box touches, in painting order. Later polygons are found from the
// end of a cell's list, earlier ones from the beginning; a search ends at the polygon itself.
#pragma once

#include <span>
#include <vector>

#include "figures/colored_order.h"
#include "painter/order/piece_grid.h"

namespace frontmost::shading {

/// The polygons of an order on the screen. Borrows the order.
class Overlaps {
 public:
  explicit Overlaps(const ColoredOrder& order);

  /// Whether two polygons overlap by more than rounding.
  [[nodiscard]] bool overlap(std::size_t a, std::size_t b) const;
  /// Call meet(other) for polygons near polygon i that are later or earlier in the order, until a call returns true;
  /// some polygons occur more than once. \returns whether a call did.
  template <class Meet>
  bool any_later(std::size_t i, const Meet& meet) const {
    return any_cell(i, [&](std::span<const std::uint32_t> cell) {
      for (std::size_t k = cell.size(); k-- > 0 && cell[k] > i;)
        if (meet(cell[k])) return true;
      return false;
    });
  }
  template <class Meet>
  bool any_earlier(std::size_t i, const Meet& meet) const {
    return any_cell(i, [&](std::span<const std::uint32_t> cell) {
      for (std::size_t k = 0; k < cell.size() && cell[k] < i; ++k)
        if (meet(cell[k])) return true;
      return false;
    });
  }

 private:
  template <class Look>
  bool any_cell(std::size_t i, const Look& look) const {
    const painter_detail::PieceGrid::Range cells = grid_.range(extents_[i]);
    for (int y = cells.first_y; y <= cells.last_y; ++y)
      for (int x = cells.first_x; x <= cells.last_x; ++x)
        if (look(grid_.cell(grid_.number(x, y)))) return true;
    return false;
  }

  const ColoredOrder& order_;
  std::vector<painter_detail::PolygonExtent> extents_;
  painter_detail::PieceGrid grid_;
};

}  // namespace frontmost::shading
