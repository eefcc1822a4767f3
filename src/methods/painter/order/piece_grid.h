// SPDX-License-Identifier: Apache-2.0
// Finds pieces that may cover another piece. A grid lists pieces by the cells of the screen that their boxes touch. If
// a cell has too many pieces, they also get boxes in space, around many pieces at a time.
//
//    +---+---+---+       cell: the pieces whose boxes touch it, in the order of their list. Two pieces that overlap on
//    | 1 |1 4|   |       the screen share a cell, because the same rounding puts both into it. They may share several
//    +---+---+---+       cells, and need to be compared in only one.
//    |   |4 7| 7 |
//    +---+---+---+
#pragma once

#include <span>
#include <vector>

#include "geometry/buckets.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// A grid over the boxes of a list of pieces. Each cell lists the pieces whose boxes touch it, as indices in that list,
/// in ascending order.
class PieceGrid {
 public:
  PieceGrid() = default;
  explicit PieceGrid(const std::vector<PolygonExtent>& extents);
  /// Replaces each index i in the cells by numbers[i].
  void renumber(const std::vector<std::uint32_t>& numbers) {
    for (std::size_t cell = 0; cell < cells_.count(); ++cell)
      for (std::uint32_t& entry : cells_[cell]) entry = numbers[entry];
  }

  /// The cells that a box touches, from the first to the last on each axis.
  struct Range {
    int first_x, last_x, first_y, last_y;
  };
  [[nodiscard]] Range range(const PolygonExtent& extent) const {
    return {index(extent.low.x, 0), index(extent.high.x, 0), index(extent.low.y, 1), index(extent.high.y, 1)};
  }
  [[nodiscard]] std::size_t number(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_[0]) + std::size_t(x);
  }
  [[nodiscard]] std::span<const std::uint32_t> cell(std::size_t number) const { return cells_[number]; }
  /// The box of a cell, in pixels. Cells at the rim of the grid extend to infinity.
  struct Box {
    glm::dvec2 low, high;
  };
  [[nodiscard]] Box box(int x, int y) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto side = [&](int i, int axis) {
      return i <= 0 ? -infinite : i >= columns_[axis] ? infinite : double(low_[axis]) + i / double(scale_[axis]);
    };
    return {{side(x, 0), side(y, 1)}, {side(x + 1, 0), side(y + 1, 1)}};
  }
  [[nodiscard]] std::size_t cell_count() const { return cells_.count(); }

 private:
  void choose_cells(const std::vector<PolygonExtent>& extents);
  /// Returns the cell of a coordinate. Rounding is monotonic, so boxes that overlap share a cell.
  [[nodiscard]] int index(float place, int axis) const {
    const float cell = (place - low_[axis]) * scale_[axis];
    return cell > 0 ? int(std::min(cell, float(columns_[axis] - 1))) : 0;
  }

  glm::vec2 low_{0}, scale_{0};  ///< corner of the grid in pixels, and cells per pixel
  glm::ivec2 columns_{1};
  Buckets<std::uint32_t> cells_;
};

/// Boxes around a list of pieces: a box around every 64 pieces, a box around every 64 of these boxes, and so on. A box
/// lies along the plane of one of its pieces, so parallel pieces, which overlap everywhere, get flat boxes one behind
/// the other.
class PieceBoxes {
 public:
  /// `pieces` are indices in `members`.
  PieceBoxes(const Pieces& all, const std::vector<std::uint32_t>& members, std::span<const std::uint32_t> pieces);

  /// Returns how many pieces from `first` on certainly lie wholly on the positive side of a plane. This is a lower
  /// bound, because only boxes that begin at `first` are tested.
  [[nodiscard]] std::size_t count_before(std::size_t first, const Plane& plane) const;

 private:
  struct Box {
    glm::dvec3 centre;
    std::array<glm::dvec3, 3> halves;  ///< vectors from the centre to the sides
    double slack;                      ///< coordinates of the pieces may exceed the box by this much
  };
  static Box box_of(const Pieces& all, const std::vector<std::uint32_t>& members,
                    std::span<const std::uint32_t> pieces);

  std::size_t count_;
  std::vector<std::vector<Box>> levels_;  ///< the smallest boxes first
};

}  // namespace frontmost::painter_detail
