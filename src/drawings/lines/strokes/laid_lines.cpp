// SPDX-License-Identifier: Apache-2.0
// A cell is as large as the mean short line and holds about one line, but is never below the distance that counts as
// one place. All lines are known before the first is laid. So crowded cells are found by counting and divided
// beforehand; the lines laid later are only pieces of the known ones.
#include "lines/strokes/laid_lines.h"

namespace frontmost::lines_detail {
namespace {

/// Cells with more lines are divided.
constexpr std::size_t kFewLines = 256;

/// A grid for `count` short lines of that mean length, about one to a cell. The least cell size matters for a drawing
/// of one point, which would have ten million cells a side.
SquareGrid grid_over(const glm::dvec2& low, const glm::dvec2& high, double count, double length, double near) {
  const double side = std::max({high.x - low.x, high.y - low.y, 1e-6});
  const double cell = std::max({length, side / std::sqrt(count), side / 4096, 8 * near});
  const glm::ivec2 cells = glm::ivec2((high - low + 2 * near) / cell) + 1;
  return {low - near, cell, cells.x, cells.y};
}

}  // namespace

LaidLines::Extent::Extent(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    low = glm::min(low, glm::min(line.from, line.to));
    high = glm::max(high, glm::max(line.from, line.to));
    if (line.is_long()) continue;
    short_length += line.length;
    ++short_count;
  }
}

LaidLines::LaidLines(const std::vector<Line>& lines, const Nearness& nearness, const Extent& extent)
    : near_(nearness), long_(extent.low, extent.high, nearness) {
  const double count = std::max(extent.short_count, 1.0);
  cells_ = CellTree(grid_over(extent.low, extent.high, count, extent.short_length / count, near_.apart()));
  divide_crowds(lines);
  lines_.resize(cells_.count());
}

void LaidLines::divide_crowds(const std::vector<Line>& lines) {
  const auto for_each_cell = [&](const SquareGrid& grid, const Line& line, const auto& visit) {
    grid.visit_along(line.from, line.to, reach_of(line), [&](int x, int y, const glm::dvec2&, const glm::dvec2&) {
      visit(grid.number(x, y));
      return true;
    });
  };
  const auto for_each_entry = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < lines.size(); ++i)
      if (!lines[i].is_long()) for_each_cell(cells_.grid(), lines[i], [&](std::uint32_t cell) { visit(cell, i); });
  };
  std::vector<std::uint32_t> counts(cells_.count(), 0), crowd_of(cells_.count(), no_index);
  for_each_entry([&](std::uint32_t cell, std::uint32_t) { ++counts[cell]; });
  std::vector<CrowdedCell<std::uint32_t>> crowds;
  std::vector<std::uint32_t> crowded;
  for (std::uint32_t cell = 0; cell < counts.size(); ++cell) {
    if (counts[cell] <= kFewLines) continue;
    crowd_of[cell] = std::uint32_t(crowds.size());
    crowds.push_back({cells_.square(cell), {}});
    crowded.push_back(cell);
  }
  if (crowds.empty()) return;
  for_each_entry([&](std::uint32_t cell, std::uint32_t i) {
    if (crowd_of[cell] != no_index) crowds[crowd_of[cell]].items.push_back(i);
  });
  const auto split = [&](const CrowdedCell<std::uint32_t>& whole) {
    const SquareGrid grid = CellTree::parts_of(whole.square);
    CellParts<std::uint32_t> parts;
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].square = grid.square(i);
    for (const std::uint32_t i : whole.items)
      for_each_cell(grid, lines[i], [&](std::uint32_t part) { parts[part].items.push_back(i); });
    return parts;
  };
  // Most lines in a crowd are short and lie on few others, so cells may be smaller than `apart`.
  const double finest = std::max(2 * Nearness::shortest, near_.apart() / 16);
  for (std::size_t i = 0; i < crowds.size(); ++i)
    cells_.graft(crowded[i], divide_cell(std::move(crowds[i]), {kFewLines, CellTree::side * finest}, split).cells);
}

}  // namespace frontmost::lines_detail
