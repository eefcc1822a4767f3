// SPDX-License-Identifier: Apache-2.0
// A cell is as large as the mean short line and holds about one line, but is never below the distance that counts as
// one place.
#include "lines/strokes/laid_lines.h"

namespace frontmost::lines_detail {
namespace {

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

LaidLines::LaidLines(const Extent& extent, const Nearness& nearness)
    : near_(nearness), long_(extent.low, extent.high, nearness) {
  const double count = std::max(extent.short_count, 1.0);
  cells_ = grid_over(extent.low, extent.high, count, extent.short_length / count, near_.apart());
  lines_.resize(cells_.count());
}

}  // namespace frontmost::lines_detail
