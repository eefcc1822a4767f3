// SPDX-License-Identifier: Apache-2.0
// Occluders by the part of the screen that they may cover, the nearest first.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <vector>

#include "lines/hiding/fine_cells.h"
#include "lines/hiding/occluder.h"
#include "lines/hiding/shadow_kernel.h"

namespace frontmost::lines_detail {

/// Lines that will be held against the occluders of a grid: where many come together, its cells are divided. None: the
/// triangles' own sides stand for them.
struct LinesToCut {
  std::size_t count = 0;
  std::function<SightedEdge(std::size_t)> line;
  /// Cells with so many occluders are divided, if their squares are together more than what looking at all lines costs.
  std::size_t crowd = 1024;
  double worth = 1 << 27;
};

/// A grid of square cells over the picture. Cells where many lines meet many occluders are divided.
class OccluderGrid {
 public:
  /// Of triangles that are seen from a side. O(triangles), with at most a score of cells a triangle, and as divide()
  /// says where they crowd. Unless it `keeps_all`, a cell that a triangle covers whole holds none that lie beyond it
  /// there: they hide the same again.
  OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const LinesToCut& lines,
               const Execution& execution);

  /// A cell's occluders, the nearest first, and what of a segment may lie in it: a box in cells' units.
  struct Visit {
    std::size_t cell, first, last;
    glm::dvec2 low, high;
    glm::dvec2 corner;  ///< the cell's
  };

  /// Calls visit(Visit) for every cell that the line passes, until it returns false. A cell in slices is visited as
  /// several, one after the other.
  template <class Visitor>
  void visit_cells(const GridLine& line, const Visitor& visit) const {
    const glm::dvec2& top = line.from.y < line.to.y ? line.from : line.to;
    const glm::dvec2& bottom = line.from.y < line.to.y ? line.to : line.from;
    // Nearly level ones lie in one row, or in both that they touch, from end to end.
    const double slope = bottom.y - top.y > 1e-9 ? (bottom.x - top.x) / (bottom.y - top.y) : 0;
    const int last_row = row(bottom.y + kPad);
    for (int y = row(top.y - kPad); y <= last_row; ++y) {
      const double low_y = std::max(y - kPad, top.y), high_y = std::min(y + 1 + kPad, bottom.y);
      const double enter = top.x + slope * (low_y - top.y);
      const double leave = slope == 0 ? bottom.x : top.x + slope * (high_y - top.y);
      const double low_x = std::min(enter, leave), high_x = std::max(enter, leave);
      const int last_column = column(high_x + kPad);
      for (int x = column(low_x - kPad); x <= last_column; ++x) {
        const std::size_t cell = number(x, y);
        const Visit visited{cell,
                            first_[cell],
                            first_[cell + 1],
                            {std::max(x - kPad, low_x), low_y},
                            {std::min(x + 1 + kPad, high_x), high_y},
                            {double(x), double(y)}};
        const bool is_divided = !fine_of_.empty() && fine_of_[cell] != no_index;
        if (!(is_divided ? visit_fine(fine_of_[cell], visited, line, visit) : visit(visited))) return;
      }
    }
  }
  /// The cell of a point in the picture.
  [[nodiscard]] std::size_t cell_of(const glm::dvec2& point) const {
    return number(column(point.x * scale_.x), row(point.y * scale_.y));
  }
  /// Without the parts of those that are divided.
  [[nodiscard]] std::size_t cell_count() const { return std::size_t(columns_) * std::size_t(rows_); }

  [[nodiscard]] ScreenBoxes boxes(std::size_t entry) const {
    return {low_x_.data() + entry, low_y_.data() + entry, high_x_.data() + entry, high_y_.data() + entry,
            nearest_.data() + entry};
  }
  /// Whether the cell knows the sides of its triangles: else an edge among many that lie side by side, at an angle,
  /// would be held against all whose boxes it meets.
  [[nodiscard]] bool has_sides(const Visit& visited) const {
    return visited.last - visited.first >= (visited.cell < cell_count() ? kMany : kManyInPart);
  }
  /// Of entries from the cell's `offset`-th on. Precondition: it has_sides().
  [[nodiscard]] ScreenSides sides(std::size_t cell, std::size_t offset) const {
    const std::size_t first = first_side_[cell] + offset;
    ScreenSides sides;
    for (int k = 0; k < ScreenSides::count; ++k) {
      sides.a[k] = sides_[3 * k].data() + first;
      sides.b[k] = sides_[3 * k + 1].data() + first;
      sides.c[k] = sides_[3 * k + 2].data() + first;
    }
    return sides;
  }
  [[nodiscard]] const Occluder& occluder(std::size_t entry) const { return occluders_[numbers_[entry]]; }
  [[nodiscard]] const glm::dvec2& scale() const { return scale_; }
  static constexpr double kPad = kCellPad;

 private:
  /// What a triangle leaves between the near and far planes, on the grid.
  struct Outline {
    std::array<glm::dvec2, 5> corners;
    int count = 0;
    double nearest = 0;
  };
  static constexpr std::size_t kMany = 512, kManyInPart = 32;
  [[nodiscard]] Visit whole(std::size_t cell) const {
    const auto columns = std::size_t(columns_);
    const glm::dvec2 corner = cell < cell_count() ? glm::dvec2(double(cell % columns), double(cell / columns))
                                                  : fine_[cell - cell_count()].corner;
    return {cell, first_[cell], first_[cell + 1], {}, {}, corner};
  }
  struct Plan;
  struct Extent {
    int first_column, last_column, first_row, last_row;
    [[nodiscard]] bool is_large() const { return last_row - first_row >= 2 && last_column > first_column; }
  };
  [[nodiscard]] double set_cells(Plan& plan, const View& view, double cells);
  [[nodiscard]] double find_footprints(Plan& plan);
  [[nodiscard]] double area_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Outline outline_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Footprint footprint_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Extent extent_of(const Footprint& footprint) const;
  [[nodiscard]] static Occluder occluder_of(const Plan& plan, const Footprint& footprint);
  [[nodiscard]] std::vector<std::atomic<float>> backs_of(const Plan& plan) const;
  void fill_cells(const Plan& plan);
  [[nodiscard]] std::vector<FineCells> divide_crowds(const Plan& plan, const LinesToCut& lines);
  [[nodiscard]] std::vector<GridLine> lines_on_grid(const Plan& plan, const LinesToCut& lines) const;
  void number_parts(const std::vector<FineCells>& parts);
  void add_entries(const Plan& plan, const std::vector<FineCells>& parts);
  void set_entry_count(std::size_t count);
  void set_entry(const Plan& plan, std::size_t e, const CellEntry& entry);
  void fill_sides(const Plan& plan);
  template <class Visitor>
  bool visit_fine(std::uint32_t number, const Visit& whole, const GridLine& line, const Visitor& visit) const;
  template <class Visitor>
  void cover(const Plan& plan, std::size_t i, const Visitor& visit) const;

  void set_side(std::size_t i, int k, const CellDepth::Side& side) {
    sides_[3 * k][i] = side.a;
    sides_[3 * k + 1][i] = side.b;
    sides_[3 * k + 2][i] = side.c;
  }
  [[nodiscard]] int row(double y) const { return int(std::clamp(y, 0.0, double(rows_ - 1))); }
  [[nodiscard]] int column(double x) const { return int(std::clamp(x, 0.0, double(columns_ - 1))); }
  [[nodiscard]] std::size_t number(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }

  /// By number beyond cell_count(): a cell within a cell.
  struct Fine {
    glm::dvec2 corner;
    std::uint32_t division, slices;
  };

  int columns_ = 1, rows_ = 1;
  glm::dvec2 scale_{1};                 ///< cells a pixel
  std::vector<std::size_t> first_;      ///< by cell: of the entries
  std::vector<std::uint32_t> fine_of_;  ///< by cell, or empty: the fine cell that it has become
  std::vector<Fine> fine_;
  std::vector<Division> divisions_;
  std::vector<Slices> slices_;
  Buffer<float> low_x_, low_y_, high_x_, high_y_, nearest_;
  Buffer<std::uint32_t> numbers_;
  std::vector<std::size_t> first_side_;  ///< by cell
  Buffer<float> sides_[3 * ScreenSides::count];
  Buffer<Occluder> occluders_;
};

template <class Visitor>
bool OccluderGrid::visit_fine(std::uint32_t number, const Visit& whole, const GridLine& line,
                              const Visitor& visit) const {
  const Fine& fine = fine_[number];
  const auto visited = [&](std::uint32_t entries) {
    const std::size_t cell = cell_count() + entries;
    return Visit{cell, first_[cell], first_[cell + 1], whole.low, whole.high, fine.corner};
  };
  if (fine.division != no_index) {
    const Division& division = divisions_[fine.division];
    return visit_parts(division, line.from, line.to, [&](int x, int y, const glm::dvec2& low, const glm::dvec2& high) {
      const auto part = division.first_cell + std::uint32_t(y * Division::side + x);
      return visit_fine(part, {0, 0, 0, low, high, {}}, line, visit);
    });
  }
  if (!visit(visited(number))) return false;
  if (fine.slices == no_index) return true;
  const Slices& slices = slices_[fine.slices];
  const Slices::Range range = slices.of(line, whole.low, whole.high);
  for (std::uint32_t i = range.first; i <= range.last; ++i)
    if (!visit(visited(slices.first_cell + i))) return false;
  return true;
}

}  // namespace frontmost::lines_detail
