// SPDX-License-Identifier: Apache-2.0
// The plan of an occluder grid: its resolution, and the cells of each triangle. It exists only while the grid is built.
// A small triangle takes the cells that its box touches. A large one takes, row by row, the cells that its outline
// touches, which may be far fewer, each with its own distance.
//
//    small: all cells of its box      large: row by row, from its left side to its right
//    +--+--+--+                       +--+--+--+--+--+
//    |##|##|  |                       |  |  |##|  |  |
//    |##|##|  |                       |  |##|##|##|  |      each cell with the least distance of the triangle
//    +--+--+--+                       |##|##|##|##|##|      within it
//                                     +--+--+--+--+--+
#pragma once

#include <array>
#include <vector>

#include "base/parallel.h"
#include "lines/hiding/cell_depth.h"
#include "lines/hiding/occluder.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// A float below the value by up to 2^-22 of it, in every rounding mode.
inline float rounded_down(double value) { return float(value - std::abs(value) * 2e-7); }
inline float rounded_up(double value) { return -rounded_down(-value); }

/// A triangle's box in cells; `nearest` is infinite for triangles that are not seen.
struct Footprint {
  glm::vec2 low, high;
  float nearest;
  std::uint32_t triangle;
};

/// The columns and rows of cells that a box touches.
struct CellRange {
  int first_column, last_column, first_row, last_row;
  /// Whether the triangle's outline may leave out some of these cells.
  [[nodiscard]] bool is_large() const { return last_row - first_row >= 2 && last_column > first_column; }
};

class GridPlan {
 public:
  /// Keeps references to its arguments. Takes fewer cells where triangles are large: a thousand large triangles before
  /// a million cells would give a thousand million entries. O(triangles).
  GridPlan(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution);

  const SeenMesh& seen;
  const Sight sight;
  const bool keeps_all;  ///< as for OccluderGrid
  const Execution& execution;
  SquareGrid grid;                   ///< over the picture, with squares of size 1
  double scale = 1;                  ///< cells per pixel
  Buffer<Footprint> footprints;      ///< of triangles that are seen, in the order of their first cells
  Buffer<CellRange> ranges;          ///< of the footprints
  Buffer<Occluder> occluders;        ///< of the footprints
  std::vector<std::uint32_t> large;  ///< indices of footprints whose ranges are large

  [[nodiscard]] CellDepth depth_of(std::uint32_t triangle) const {
    const glm::uvec3& t = seen.mesh.triangles[triangle];
    return {places_[t.x], places_[t.y], places_[t.z], sight.is_parallel()};
  }
  /// Whether a part of the triangle may lie before the near plane.
  [[nodiscard]] bool is_near(const Footprint& footprint) const {
    return double(footprint.nearest) <= sight.near() + 1e-6 * std::abs(sight.near());
  }
  /// Calls visit(cell, nearest) for every cell that the footprint's triangle may touch, with its least distance there.
  template <class Visitor>
  void visit_cells(std::size_t number, const Visitor& visit) const {
    const CellRange& all = ranges[number];
    const Footprint& footprint = footprints[number];
    if (all.is_large()) return visit_rows(footprint, all, visit);
    for (int y = all.first_row; y <= all.last_row; ++y)
      for (int x = all.first_column; x <= all.last_column; ++x) visit(grid.number(x, y), footprint.nearest);
  }

 private:
  /// The part of a triangle between the near and far planes, as a polygon in cells.
  struct Outline {
    std::array<glm::dvec2, 5> corners;
    int count = 0;
    double nearest = 0;
  };
  /// The left and right ends, in cells; empty if left > right.
  struct Span {
    double left, right;
  };
  void set_cells(const View& view, double cells);
  void find_footprints();
  [[nodiscard]] Footprint footprint_of(std::uint32_t triangle) const;
  [[nodiscard]] CellRange range_of(const Footprint& footprint) const;
  [[nodiscard]] Outline outline_of(std::uint32_t triangle) const;
  [[nodiscard]] Occluder occluder_of(const Footprint& footprint) const;
  [[nodiscard]] double area_of(std::uint32_t triangle) const;
  [[nodiscard]] double entries_of(const Footprint& footprint, const CellRange& range) const;
  [[nodiscard]] static Span within_row(const Outline& outline, int row);
  [[nodiscard]] int column(double x) const { return int(std::clamp(x, 0.0, double(grid.columns - 1))); }
  [[nodiscard]] int row(double y) const { return int(std::clamp(y, 0.0, double(grid.rows - 1))); }

  /// Visits the cells that the outline touches, row by row.
  template <class Visitor>
  void visit_rows(const Footprint& footprint, const CellRange& all, const Visitor& visit) const {
    const Outline outline = outline_of(footprint.triangle);
    const CellDepth depth = depth_of(footprint.triangle);
    for (int y = all.first_row; y <= all.last_row; ++y) {
      const Span span = within_row(outline, y);
      const int last = column(std::min(double(footprint.high.x), span.right) + kCellPad);
      for (int x = column(std::max(double(footprint.low.x), span.left) - kCellPad); x <= last; ++x)
        visit(grid.number(x, y), std::max(footprint.nearest, rounded_down(depth.nearest(grid.square(x, y)))));
    }
  }

  Buffer<glm::dvec3> places_;  ///< of vertices: x and y in cells, z the planar distance
  double entries_ = 0;         ///< an upper bound on the cells that all footprints take
};

}  // namespace frontmost::lines_detail
