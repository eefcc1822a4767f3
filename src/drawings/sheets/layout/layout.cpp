// SPDX-License-Identifier: Apache-2.0
// A line of cells is as wide as its widest view before the anchor and its widest behind it, both times the scale. Room
// for annotations is added, which does not scale. So the size of a layout is linear in the scale, and the largest scale
// for an area is a division.
//
//    before  anchor  behind   gap   before  anchor  behind
//    |---------+--------|           |-----------+------|        one line of cells, along one axis
#include "sheets/layout/layout.h"

#include <algorithm>

namespace frontmost::detail {

glm::ivec2 cell_of(NamedView view, ProjectionMethod method) {
  // Third-angle: the view from a side is placed on that side. First-angle: on the opposite side.
  const int side = method == ProjectionMethod::third_angle ? 1 : -1;
  switch (view) {
    case NamedView::front: return {0, 0};
    case NamedView::left: return {-side, 0};
    case NamedView::right: return {side, 0};
    case NamedView::top: return {0, -side};
    case NamedView::bottom: return {0, side};
    case NamedView::back: return {2, 0};
    case NamedView::iso:
    case NamedView::three_quarter: return {1, -side};
  }
  return {0, 0};
}

std::vector<SheetLayout::Line> SheetLayout::lines_of(const std::vector<ViewCell>& cells, int axis) {
  std::vector<Line> lines;
  for (const ViewCell& cell : cells) {
    const int number = axis == 0 ? cell.column : cell.row;
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.number == number; });
    if (line == lines.end()) line = lines.insert(line, {number, -cell.low[axis], cell.high[axis]});
    line->before = std::max(line->before, -cell.low[axis]);
    line->behind = std::max(line->behind, cell.high[axis]);
    line->room_before = std::max(line->room_before, cell.room_before[axis]);
    line->room_behind = std::max(line->room_behind, cell.room_behind[axis]);
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
  return lines;
}

SheetLayout::SheetLayout(const std::vector<ViewCell>& cells, const glm::dvec2& gap) : cells_(cells), gap_(gap) {
  for (int axis = 0; axis < 2; ++axis) {
    lines_[axis] = lines_of(cells, axis);
    gaps_[axis] = gap[axis] * double(lines_[axis].size() - 1);
    for (const Line& line : lines_[axis]) {
      extent_[axis] += line.before + line.behind;
      gaps_[axis] += line.room_before + line.room_behind;
    }
  }
}

double SheetLayout::largest_scale(const glm::dvec2& area) const {
  double scale = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis)
    if (extent_[axis] > 0) scale = std::min(scale, (area[axis] - gaps_[axis]) / extent_[axis]);
  return scale < std::numeric_limits<double>::infinity() ? std::max(scale, 0.0) : 1;
}

double SheetLayout::place(const ViewCell& cell, int axis, double scale) const {
  double at = 0;
  for (const Line& line : lines_[axis]) {
    at += line.room_before + line.before * scale;
    if (line.number == (axis == 0 ? cell.column : cell.row)) return at;
    at += line.behind * scale + line.room_behind + gap_[axis];
  }
  return at;
}

std::vector<glm::dvec2> SheetLayout::anchors(double scale, const glm::dvec2& corner) const {
  std::vector<glm::dvec2> anchors;
  for (const ViewCell& cell : cells_)
    anchors.push_back(corner + glm::dvec2(place(cell, 0, scale), place(cell, 1, scale)));
  return anchors;
}

bool SheetLayout::leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const {
  const std::vector<glm::dvec2> places = anchors(scale, corner);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const glm::dvec2 end = places[i] + cells_[i].high * scale + cells_[i].room_behind;
    if (end.x > block.x && end.y > block.y) return false;
  }
  return true;
}

}  // namespace frontmost::detail
