// SPDX-License-Identifier: Apache-2.0
// Division of a crowded cell, for both indices of this room.
//
// The details of a large scene are tiny, so all of their triangles and lines share a few cells. Each would be compared
// with all others there. In the parts of a divided cell they meet only what is near them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lines/cell_tree.h"

namespace frontmost::lines_detail {

/// A cell and its items.
template <class Item>
struct CrowdedCell {
  Square square;
  std::vector<Item> items;
};

/// The parts of a cell, row by row. An item may be in several parts.
template <class Item>
using CellParts = std::array<CrowdedCell<Item>, CellTree::parts>;

/// A divided cell, as a tree in which it is cell 0.
template <class Item>
struct DividedCell {
  CellTree cells;
  std::vector<std::vector<Item>> items;  ///< by cell; divided cells have none
};

/// Limits beyond which a cell is not divided.
struct DivisionLimits {
  std::size_t few = 64;       ///< so many items are not worth dividing
  double least_size = 0;      ///< least side length of a cell's square
  std::size_t most_held = 9;  ///< the parts may hold so many times as many items as the cell: this bounds memory
};

/// The cost of one query for each item of a cell. Each query compares with all items, and the visit to the cell costs
/// as much as 128 more.
template <class Item>
double cost_of_asking(const CrowdedCell<Item>& cell) {
  constexpr double visit = 128;
  return double(cell.items.size()) * (double(cell.items.size()) + visit);
}

/// Whether the parts cost less than the whole: all parts together, or all but one, which may be divided again.
template <class Item>
bool is_worth_dividing(const CrowdedCell<Item>& whole, const CellParts<Item>& parts) {
  double sum = 0, most = 0;
  for (const CrowdedCell<Item>& part : parts) {
    sum += cost_of_asking(part);
    most = std::max(most, cost_of_asking(part));
  }
  return sum < 0.75 * cost_of_asking(whole) || sum - most < 0.5 * cost_of_asking(whole);
}

/// Divides a cell, its parts, and theirs, as long as that makes queries cheaper. `split(CrowdedCell)` gives the
/// CellParts.
///
/// Cost of all queries afterwards: O(n log n) for n items that lie apart in small enough parts; n^2 for n items that
/// lie upon each other in all parts.
template <class Item, class Split>
[[nodiscard]] DividedCell<Item> divide_cell(CrowdedCell<Item> cell, const DivisionLimits& limits, const Split& split) {
  DividedCell<Item> divided{CellTree({{cell.square.x, cell.square.y}, cell.square.size, 1, 1}), {}};
  divided.items.resize(1);
  // `room`: how many items the parts may hold.
  const auto divide = [&](const auto& self, std::uint32_t number, CrowdedCell<Item> whole, std::size_t room) -> void {
    if (whole.items.size() > limits.few && whole.square.size >= limits.least_size) {
      CellParts<Item> parts = split(whole);
      std::size_t held = 0;
      double costs = 1;
      for (const CrowdedCell<Item>& part : parts) {
        held += part.items.size();
        costs += cost_of_asking(part);
      }
      if (held <= room && is_worth_dividing(whole, parts)) {
        const std::uint32_t first = divided.cells.divide(number);
        divided.items.resize(divided.cells.count());
        whole.items = {};
        // Each part may hold its own items and a share of the remaining room, in proportion to its cost.
        for (std::uint32_t i = 0; i < parts.size(); ++i) {
          const std::size_t own = parts[i].items.size();
          const auto share = std::size_t(double(room - held) * (cost_of_asking(parts[i]) / costs));
          self(self, first + i, std::move(parts[i]), own + share);
        }
        return;
      }
    }
    divided.items[number] = std::move(whole.items);
  };
  const std::size_t room = limits.most_held * cell.items.size();
  divide(divide, 0, std::move(cell), room);
  return divided;
}

}  // namespace frontmost::lines_detail
