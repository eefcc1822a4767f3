// SPDX-License-Identifier: Apache-2.0
// Lists occluders by the cells of the picture that they may cover, the nearest first.
//
// A grid of square cells lies over the picture, with about 32 triangles per cell. Each cell lists the triangles that
// may cover some of it. A triangle behind another that covers the whole cell hides nothing more there and is left out.
#pragma once

#include <atomic>
#include <vector>

#include "lines/hiding/occluder.h"
#include "lines/mesh/mesh.h"
#include "lines/square_grid.h"

namespace frontmost::lines_detail {

/// A function of the distance that is linear on the screen; larger values are nearer.
[[nodiscard]] inline double nearness(double distance, bool is_parallel) {
  return is_parallel ? -distance : 1 / distance;
}

/// A margin, in units of cells, above the rounding error of any place in the picture.
inline constexpr double kCellPad = 1e-6;

class GridPlan;

class OccluderGrid {
 public:
  /// Takes the triangles that are not seen edge-on. Unless `keeps_all`, each cell omits triangles that lie wholly
  /// behind a triangle that covers the whole cell. O(triangles), with at most about 20 cells per triangle.
  OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution);

  /// A cell that a segment passes. Its occluders are the entries from `first` to `last`.
  struct Visit : PassedCell {
    std::size_t first, last;
  };

  /// Calls visit(Visit) for every cell that the segment passes, until `visit` returns false. `from` and `to` are in
  /// units of cells.
  template <class Visitor>
  void visit_cells(const glm::dvec2& from, const glm::dvec2& to, const Visitor& visit) const {
    cells_.visit_along(from, to, kCellPad, [&](const PassedCell& passed) {
      return visit(Visit{passed, first_[passed.cell], first_[passed.cell + 1]});
    });
  }

  /// The boxes of the entries from number `entry` on.
  [[nodiscard]] ScreenBoxes boxes(std::size_t entry) const {
    return {low_x_.data() + entry, low_y_.data() + entry, high_x_.data() + entry, high_y_.data() + entry,
            nearest_.data() + entry};
  }
  /// Whether the cell stores the sides of its triangles, as cells with many entries do. Without sides, an edge among
  /// many parallel slanting triangles would be compared with all triangles whose boxes it meets.
  [[nodiscard]] bool has_sides(const Visit& visit) const { return has_sides(visit.cell); }
  /// The sides of the cell's entries from index `offset` on. Precondition: has_sides().
  [[nodiscard]] ScreenSides sides(std::uint32_t cell, std::size_t offset) const {
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
  /// Cells per pixel.
  [[nodiscard]] double scale() const { return scale_; }

  /// The cell with most entries, and its nearest triangle.
  struct Crowd {
    std::size_t count = 0;
    std::uint32_t triangle = no_index;
  };
  [[nodiscard]] Crowd largest_crowd() const;

 private:
  static constexpr std::size_t kMany = 512;
  [[nodiscard]] bool has_sides(std::size_t cell) const { return first_[cell + 1] - first_[cell] >= kMany; }
  void fill_cells(const GridPlan& plan);
  void fill_sides(const GridPlan& plan);

  SquareGrid cells_;
  double scale_ = 1;
  std::vector<std::size_t> first_;  ///< by cell: index of its first entry
  Buffer<float> low_x_, low_y_, high_x_, high_y_, nearest_;
  Buffer<std::uint32_t> numbers_;
  std::vector<std::size_t> first_side_;  ///< by cell
  Buffer<float> sides_[3 * ScreenSides::count];
  Buffer<Occluder> occluders_;
};

}  // namespace frontmost::lines_detail
