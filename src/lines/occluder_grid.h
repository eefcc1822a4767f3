// SPDX-License-Identifier: Apache-2.0
// Occluders by the part of the screen that they may cover, the nearest first.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "lines/cell_depth.h"
#include "lines/occluder.h"
#include "lines/seen_mesh.h"
#include "lines/shadow_kernel.h"

namespace frontmost::lines_detail {

/// A grid of square cells over the picture.
class OccluderGrid {
 public:
  /// Of triangles that are seen from a side. O(triangles), with at most a score of cells a triangle. Unless it
  /// `keeps_all`, a cell that a triangle covers whole holds none that lie beyond it there: they hide the same again.
  OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution);

  /// A cell's occluders, the nearest first, and what of a segment may lie in it: a box in cells' units.
  struct Visit {
    std::size_t cell, first, last;
    glm::dvec2 low, high;
  };

  /// Calls visit(Visit) for every cell that the segment between two points of the picture passes, until it returns
  /// false.
  template <class Visitor>
  void visit_cells(const glm::dvec2& from, const glm::dvec2& to, const Visitor& visit) const {
    const glm::dvec2 a = from * scale_, b = to * scale_;
    const glm::dvec2& top = a.y < b.y ? a : b;
    const glm::dvec2& bottom = a.y < b.y ? b : a;
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
        if (!visit(Visit{cell,
                         first_[cell],
                         first_[cell + 1],
                         {std::max(x - kPad, low_x), low_y},
                         {std::min(x + 1 + kPad, high_x), high_y}}))
          return;
      }
    }
  }
  /// The cell of a point in the picture.
  [[nodiscard]] std::size_t cell_of(const glm::dvec2& point) const {
    return number(column(point.x * scale_.x), row(point.y * scale_.y));
  }
  [[nodiscard]] std::size_t cell_count() const { return first_.size() - 1; }

  [[nodiscard]] ScreenBoxes boxes(std::size_t entry) const {
    return {low_x_.data() + entry, low_y_.data() + entry, high_x_.data() + entry, high_y_.data() + entry,
            nearest_.data() + entry};
  }
  /// A cell of so many entries knows the sides of its triangles: else an edge among many that lie side by side, at an
  /// angle, would be held against all whose boxes it meets.
  static constexpr std::size_t kMany = 512;
  /// Of entries from the cell's `offset`-th on. Precondition: it has kMany.
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
  /// The cell's corner.
  [[nodiscard]] glm::dvec2 corner(std::size_t cell) const {
    return {double(cell % std::size_t(columns_)), double(cell / std::size_t(columns_))};
  }
  [[nodiscard]] const Occluder& occluder(std::size_t entry) const { return occluders_[numbers_[entry]]; }
  [[nodiscard]] const glm::dvec2& scale() const { return scale_; }
  /// Cells: more than the rounding of any place in the picture.
  static constexpr double kPad = 1e-6;

 private:
  /// What a triangle leaves between the near and far planes, on the grid.
  struct Outline {
    std::array<glm::dvec2, 5> corners;
    int count = 0;
    double nearest = 0;
  };
  /// A triangle's box in cells' units; `nearest` is infinite where it is not seen.
  struct Footprint {
    glm::vec2 low, high;
    float nearest;
    std::uint32_t triangle;
  };
  struct Plan;
  struct Band {
    int first, last;  ///< rows
  };
  struct Extent {
    int first_column, last_column, first_row, last_row;
    [[nodiscard]] bool is_large() const { return last_row - first_row >= 2 && last_column > first_column; }
  };
  [[nodiscard]] Buffer<Footprint> set_cells(Plan& plan, const View& view, double cells);
  [[nodiscard]] double entries_of(Plan& plan, const Buffer<Footprint>& footprints) const;
  [[nodiscard]] double area_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Outline outline_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Footprint footprint_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] Extent extent_of(const Footprint& footprint) const;
  [[nodiscard]] CellDepth depth_of(const Plan& plan, std::uint32_t triangle) const;
  [[nodiscard]] bool is_near(const Plan& plan, const Footprint& footprint) const;
  [[nodiscard]] Buffer<Footprint> footprints_by_cell(const Plan& plan) const;
  [[nodiscard]] Buffer<float> backs_of(const Plan& plan, const Buffer<Footprint>& footprints) const;
  void make_occluders(const Plan& plan, const Buffer<Footprint>& footprints);
  void fill_cells(const Plan& plan, const Buffer<Footprint>& footprints);
  void fill_sides(const Plan& plan);
  template <class Fill>
  void for_each_band(const Execution& execution, const Fill& fill) const;
  template <class Visitor>
  void cover(const Plan& plan, const Footprint& footprint, const Band& band, const Visitor& visit) const;

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

  int columns_ = 1, rows_ = 1;
  glm::dvec2 scale_{1};             ///< cells a pixel
  std::vector<std::size_t> first_;  ///< by cell: of the entries
  Buffer<float> low_x_, low_y_, high_x_, high_y_, nearest_;
  Buffer<std::uint32_t> numbers_;
  std::vector<std::size_t> first_side_;  ///< by cell
  Buffer<float> sides_[3 * ScreenSides::count];
  Buffer<Occluder> occluders_;
};

}  // namespace frontmost::lines_detail
