// SPDX-License-Identifier: Apache-2.0
// Cells of a grid where many lines meet many occluders, divided again.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lines/hiding/footprint.h"

namespace frontmost::lines_detail {

/// An occluder in a cell. The nearest first.
struct CellEntry {
  float nearest;  ///< of what may lie in the cell
  std::uint32_t footprint;
  friend bool operator<(const CellEntry& a, const CellEntry& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.footprint < b.footprint;
  }
};

/// What is seen of a line, in cells. An end that is a vertex is where that is seen; no_index: there is none.
struct GridLine {
  glm::dvec2 from{0}, to{0};
  std::uint32_t from_vertex = no_index, to_vertex = no_index;
};

/// A square in parts of equal size, row by row.
struct Division {
  static constexpr int side = 4, count = side * side;
  Square part;               ///< the first
  std::uint32_t first_cell;  ///< the others follow
  [[nodiscard]] Square at(int x, int y) const { return {part.x + x * part.size, part.y + y * part.size, part.size}; }
};

/// What of a line may lie in a box.
inline GridLine within_box(const GridLine& line, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::dvec2 along = line.to - line.from;
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(along[axis]) < 1e-9) continue;  // all of it, for what rounding would leave of it
    const double at_low = (low[axis] - kCellPad - line.from[axis]) / along[axis],
                 at_high = (high[axis] + kCellPad - line.from[axis]) / along[axis];
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
  if (!(begin < end)) begin = end = 0.5 * (begin + end);
  return {line.from + along * begin, line.from + along * end};
}

/// A cell in sectors around a vertex at which many triangles meet that reach out of the cell, like a cone's: a line
/// from there can be hidden near it only by those that lie where it goes. The cell behind those of the sectors has all
/// of them, for other lines. Or a cell in strips.
struct Slices {
  std::uint32_t apex;  ///< the vertex; no_index: strips
  glm::dvec2 across;   ///< of strips: where their offsets go
  std::uint32_t first_cell;
  std::vector<double> begins;            ///< ascending: angles from the x axis to y, or offsets along `across`
  static constexpr double reach = 1e-3;  ///< cells: shorter lines have no certain direction

  /// Which slice has the value; the first begins where values do.
  [[nodiscard]] std::uint32_t slice_of(double value) const {
    const auto next = std::upper_bound(begins.begin(), begins.end(), value);
    return std::uint32_t(std::max<std::ptrdiff_t>(next - begins.begin(), 1) - 1);
  }
  struct Range {
    std::uint32_t first, last;
  };
  /// Of a line that passes the box: which cells from `first_cell` on it asks.
  [[nodiscard]] Range of(const GridLine& line, const glm::dvec2& low, const glm::dvec2& high) const {
    if (apex == no_index) {
      const GridLine part = within_box(line, low, high);
      const double from = glm::dot(across, part.from), to = glm::dot(across, part.to);
      return {slice_of(std::min(from, to) - kCellPad), slice_of(std::max(from, to) + kCellPad)};
    }
    const glm::dvec2 along = line.from_vertex == apex ? line.to - line.from : line.from - line.to;
    const bool begins_there = line.from_vertex == apex || line.to_vertex == apex;
    if (!begins_there || glm::dot(along, along) < reach * reach)
      return {std::uint32_t(begins.size()), std::uint32_t(begins.size())};
    const std::uint32_t sector = slice_of(std::atan2(along.y, along.x));
    return {sector, sector};
  }
};

/// A cell that is divided has no entries of its own; one in slices has those that no slice has.
struct FineCell {
  glm::dvec2 corner{0};
  std::vector<CellEntry> entries;
  std::uint32_t division = no_index, slices = no_index;
};

/// Cell 0 is the one that was divided.
struct FineCells {
  std::vector<FineCell> cells;
  std::vector<Division> divisions;
  std::vector<Slices> slices;
};

/// Calls visit(x, y, low, high) for the parts of a division that the segment between two points passes, with a box of
/// what may lie in each, until it returns false. \returns false if it did.
template <class Visitor>
bool visit_parts(const Division& division, const glm::dvec2& a, const glm::dvec2& b, const Visitor& visit) {
  const Square& first = division.part;
  const auto part = [&](double place, double corner) {
    return int(std::clamp(std::floor((place - corner) / first.size), -1.0, double(Division::side)));
  };
  const glm::dvec2& top = a.y < b.y ? a : b;
  const glm::dvec2& bottom = a.y < b.y ? b : a;
  // As in the grid: nearly level ones lie in one row, or in both that they touch, from end to end.
  const double slope = bottom.y - top.y > 1e-9 ? (bottom.x - top.x) / (bottom.y - top.y) : 0;
  const int last_row = std::min(part(bottom.y + kCellPad, first.y), Division::side - 1);
  for (int y = std::max(part(top.y - kCellPad, first.y), 0); y <= last_row; ++y) {
    const double row = first.y + y * first.size;
    const double low_y = std::max(row - kCellPad, top.y), high_y = std::min(row + first.size + kCellPad, bottom.y);
    const double enter = top.x + slope * (low_y - top.y);
    const double leave = slope == 0 ? bottom.x : top.x + slope * (high_y - top.y);
    const double low_x = std::min(enter, leave), high_x = std::max(enter, leave);
    const int last_column = std::min(part(high_x + kCellPad, first.x), Division::side - 1);
    for (int x = std::max(part(low_x - kCellPad, first.x), 0); x <= last_column; ++x) {
      const double column = first.x + x * first.size;
      if (!visit(x, y, glm::dvec2(std::max(column - kCellPad, low_x), low_y),
                 glm::dvec2(std::min(column + first.size + kCellPad, high_x), high_y)))
        return false;
    }
  }
  return true;
}

/// What a cell holds that is to be divided.
struct Crowd {
  Square square;
  std::vector<CellEntry> entries;    ///< the nearest first
  std::vector<std::uint32_t> lines;  ///< that pass it
  std::size_t room = 0;              ///< so many more entries may be made of these: what bounds memory
};

/// What crowds are made of.
struct CrowdedGrid {
  const OnGrid& on_grid;
  const Buffer<Footprint>& footprints;
  const std::vector<GridLine>& lines;
  const bool keeps_all;  ///< as OccluderGrid's
};

/// Parts of a cell, and parts of those, as long as lines have less to ask there. Unless all is kept, a part that a
/// triangle covers whole holds none whose planes lie beyond it there. (J. Warnock. A Hidden Surface Algorithm for
/// Computer Generated Halftone Pictures. 1969.) The cost follows what is left: where lines and occluders lie apart in
/// small enough parts, side by side, or around a vertex, O(n log n); where they lie upon each other their product
/// remains.
[[nodiscard]] FineCells divide(const CrowdedGrid& grid, Crowd crowd, const Execution& execution);

}  // namespace frontmost::lines_detail
