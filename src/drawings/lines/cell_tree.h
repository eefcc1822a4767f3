// SPDX-License-Identifier: Apache-2.0
// This index serves both crowds of this room: triangles that may hide an edge, and lines that may lie on another line.
//
//   +-------+-------+-------+      A grid of square cells lies over the plane. A crowded cell is divided
//   |       |+-+-+-+|       |      into 4 x 4 cells, and these may be divided again.
//   |    .--++-+-+-+|       |      A segment visits the undivided cells that it passes, each with a box
//   |.--'   |+-+-+-+|       |      around the part of the segment that may lie in the cell.
//   +-------+-------+-------+
//
// The tree knows cells only by their numbers. Callers keep the contents of cells in arrays, by cell number.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

/// An axis-aligned square of a plane; (x, y) is its low corner.
struct Square {
  double x, y, size = 1;
};

/// Equal squares side by side, row by row.
struct SquareGrid {
  glm::dvec2 low{0};
  double size = 1;  ///< of a square
  int columns = 1, rows = 1;

  [[nodiscard]] std::size_t count() const { return std::size_t(columns) * std::size_t(rows); }
  [[nodiscard]] std::uint32_t number(int x, int y) const {
    return std::uint32_t(y) * std::uint32_t(columns) + std::uint32_t(x);
  }
  [[nodiscard]] Square square(int x, int y) const { return {low.x + x * size, low.y + y * size, size}; }
  [[nodiscard]] Square square(std::size_t number) const {
    return square(int(number % std::size_t(columns)), int(number / std::size_t(columns)));
  }

  /// Calls visit(x, y, low, high) for the squares that the segment from `a` to `b` passes within `pad`, row by row from
  /// low to high, until `visit` returns false. `low` and `high` are a box around the part of the segment that may lie
  /// in the square. \returns false if `visit` did.
  template <class Visitor>
  bool visit_along(const glm::dvec2& a, const glm::dvec2& b, double pad, const Visitor& visit) const {
    const glm::dvec2& bottom = a.y < b.y ? a : b;
    const glm::dvec2& top = a.y < b.y ? b : a;
    // A nearly level segment lies in one row, or in both rows that it touches, from end to end.
    const double slope = top.y - bottom.y > 1e-3 * pad ? (top.x - bottom.x) / (top.y - bottom.y) : 0;
    const int last_row = std::min(row(top.y + pad), rows - 1);
    for (int y = std::max(row(bottom.y - pad), 0); y <= last_row; ++y) {
      const double edge = low.y + y * size;
      const double low_y = std::max(edge - pad, bottom.y), high_y = std::min(edge + size + pad, top.y);
      const double enter = bottom.x + slope * (low_y - bottom.y);
      const double leave = slope == 0 ? top.x : bottom.x + slope * (high_y - bottom.y);
      const double low_x = std::min(enter, leave), high_x = std::max(enter, leave);
      const int last_column = std::min(column(high_x + pad), columns - 1);
      for (int x = std::max(column(low_x - pad), 0); x <= last_column; ++x) {
        const double side = low.x + x * size;
        const glm::dvec2 from(std::max(side - pad, low_x), low_y), to(std::min(side + size + pad, high_x), high_y);
        if (!visit(x, y, from, to)) return false;
      }
    }
    return true;
  }

  /// Calls visit(x, y) for the squares that a box touches within `pad`.
  template <class Visitor>
  void visit_box(const glm::dvec2& from, const glm::dvec2& to, double pad, const Visitor& visit) const {
    const int first_column = std::max(column(from.x - pad), 0), last_column = std::min(column(to.x + pad), columns - 1);
    const int first_row = std::max(row(from.y - pad), 0), last_row = std::min(row(to.y + pad), rows - 1);
    for (int y = first_row; y <= last_row; ++y)
      for (int x = first_column; x <= last_column; ++x) visit(x, y);
  }

 private:
  /// The square's index along one axis, from -1 to `count`; both of these lie outside of the grid.
  [[nodiscard]] int index(double offset, int count) const {
    return int(std::clamp(offset / size + 1, 0.0, count + 1.0)) - 1;
  }
  [[nodiscard]] int column(double x) const { return index(x - low.x, columns); }
  [[nodiscard]] int row(double y) const { return index(y - low.y, rows); }
};

/// A cell that a segment passes, and a box around the part of the segment that may lie in the cell.
struct PassedCell {
  std::uint32_t cell;
  Square square;
  glm::dvec2 low, high;
};

/// A grid whose crowded cells are divided. The cells of the grid are numbered row by row. The 16 parts of a divided
/// cell take the next free numbers.
class CellTree {
 public:
  static constexpr int side = 4, parts = side * side;

  CellTree() : CellTree(SquareGrid{}) {}
  explicit CellTree(const SquareGrid& grid) : grid_(grid), whole_(grid.count()), division_(whole_, no_index) {}

  /// The number of all cells, divided ones included; and the number of the grid's own cells.
  [[nodiscard]] std::size_t count() const { return division_.size(); }
  [[nodiscard]] std::size_t whole_count() const { return whole_; }
  [[nodiscard]] const SquareGrid& grid() const { return grid_; }
  [[nodiscard]] bool is_divided(std::uint32_t cell) const { return division_[cell] != no_index; }

  [[nodiscard]] Square square(std::uint32_t cell) const {
    return cell < whole_ ? grid_.square(cell) : divisions_[(cell - whole_) / parts].square((cell - whole_) % parts);
  }

  /// The 4 x 4 parts of a square.
  [[nodiscard]] static SquareGrid parts_of(const Square& square) {
    return {{square.x, square.y}, square.size / side, side, side};
  }

  /// Divides a cell. \returns the number of its first part; the others follow, row by row.
  std::uint32_t divide(std::uint32_t cell) {
    const auto first = std::uint32_t(count());
    division_[cell] = std::uint32_t(divisions_.size());
    divisions_.push_back(parts_of(square(cell)));
    division_.resize(first + parts, no_index);
    return first;
  }

  /// Divides an undivided cell as cell 0 of `other` is divided. The cells of `other` from 1 on take the next numbers.
  void graft(std::uint32_t cell, const CellTree& other) {
    const auto shifted = [shift = std::uint32_t(divisions_.size())](std::uint32_t division) {
      return division == no_index ? no_index : division + shift;
    };
    divisions_.insert(divisions_.end(), other.divisions_.begin(), other.divisions_.end());
    division_[cell] = shifted(other.division_[0]);
    for (std::size_t i = 1; i < other.count(); ++i) division_.push_back(shifted(other.division_[i]));
  }

  /// Calls visit(PassedCell) for the undivided cells that the segment passes within `pad`, until it returns false.
  template <class Visitor>
  void visit_along(const glm::dvec2& a, const glm::dvec2& b, double pad, const Visitor& visit) const {
    (void)visit_grid(grid_, 0, {a, b, pad}, visit);
  }

 private:
  struct Way {
    const glm::dvec2 &a, &b;
    const double pad;
  };

  template <class Visitor>
  bool visit_grid(const SquareGrid& grid, std::uint32_t first, const Way& way, const Visitor& visit) const {
    return grid.visit_along(way.a, way.b, way.pad, [&](int x, int y, const glm::dvec2& low, const glm::dvec2& high) {
      const std::uint32_t cell = first + grid.number(x, y), division = division_[cell];
      if (division == no_index) return bool(visit(PassedCell{cell, grid.square(x, y), low, high}));
      return visit_grid(divisions_[division], std::uint32_t(whole_) + division * parts, way, visit);
    });
  }

  SquareGrid grid_;
  std::size_t whole_;
  std::vector<std::uint32_t> division_;  ///< by cell: index into `divisions_`, or no_index
  std::vector<SquareGrid> divisions_;
};

}  // namespace frontmost::lines_detail
