// SPDX-License-Identifier: Apache-2.0
// A grid of square cells over a plane, for the indices of this room: triangles that may hide an edge, lines that may
// lie on another line, and ends of short chains. Callers keep the contents of cells in arrays, by cell number.
//
//   +-------+-------+-------+
//   |       |      .|--'    |      A segment visits the cells that it passes, each with a box around the part of the
//   |    .--+--' '  |       |      segment that may lie in the cell.
//   +-------+-------+-------+
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace frontmost::lines_detail {

/// An axis-aligned square of a plane; (x, y) is its low corner.
struct Square {
  double x, y, size = 1;
};

/// A cell that a segment passes, and a box around the part of the segment that may lie in the cell.
struct PassedCell {
  std::uint32_t cell;
  Square square;
  glm::dvec2 low, high;
};

/// Squares are numbered row by row.
struct SquareGrid {
  glm::dvec2 low{0};
  double size = 1;  ///< side length of a square
  int columns = 1, rows = 1;

  [[nodiscard]] std::size_t count() const { return std::size_t(columns) * std::size_t(rows); }
  [[nodiscard]] std::uint32_t number(int x, int y) const {
    return std::uint32_t(y) * std::uint32_t(columns) + std::uint32_t(x);
  }
  [[nodiscard]] Square square(int x, int y) const { return {low.x + x * size, low.y + y * size, size}; }
  [[nodiscard]] Square square(std::size_t number) const {
    return square(int(number % std::size_t(columns)), int(number / std::size_t(columns)));
  }

  /// Calls visit(PassedCell) for the squares that a segment passes within `pad`, row by row, until it returns false.
  template <class Visitor>
  void visit_along(const glm::dvec2& a, const glm::dvec2& b, double pad, const Visitor& visit) const {
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
        if (!visit(PassedCell{number(x, y), square(x, y), from, to})) return;
      }
    }
  }

 private:
  /// The index of a square along one axis, from -1 to `count`. Squares -1 and `count` are outside of the grid.
  [[nodiscard]] int index(double offset, int count) const {
    return int(std::clamp(offset / size + 1, 0.0, count + 1.0)) - 1;
  }
  [[nodiscard]] int column(double x) const { return index(x - low.x, columns); }
  [[nodiscard]] int row(double y) const { return index(y - low.y, rows); }
};

}  // namespace frontmost::lines_detail
