// SPDX-License-Identifier: Apache-2.0
// What a triangle does in the squares of a plane: which of them it covers, and how far away it is there.
//
// A triangle that covers a cell whole hides all that lies beyond it there, and what lies beside a cell need not be
// listed in it. Both are asked of rounded places, so each answer leaves room for what rounding may do: "covers" and "is
// beside" are true only where that is certain.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "lines/cell_tree.h"

namespace frontmost::lines_detail {

/// Linear on the screen, and the larger the nearer.
[[nodiscard]] inline double nearness(double distance, bool is_parallel) {
  return is_parallel ? -distance : 1 / distance;
}

/// Cells: more than the rounding of any place in the picture.
inline constexpr double kCellPad = 1e-6;

/// Bounds that hold whatever rounding did, for a triangle none of which is before the near plane.
class CellDepth {
 public:
  /// Places have x and y in cells and z the planar distance. In perspective its inverse is what is linear on the
  /// screen.
  CellDepth(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool is_parallel);

  /// Bounds of its distance within a square.
  [[nodiscard]] double nearest(const Square& square) const;
  [[nodiscard]] double farthest(const Square& square) const;
  /// Whether it surely lies beside the square; or covers it whole.
  [[nodiscard]] bool is_beside(const Square& square) const;
  [[nodiscard]] bool covers(const Square& square) const;
  /// Whether the square is surely within side k, from corner k to the next; or without.
  [[nodiscard]] bool is_within(int k, const Square& square) const { return has_sides_ && sides_[k].at(square, -1) > 0; }
  [[nodiscard]] bool is_without(int k, const Square& square) const { return has_sides_ && sides_[k].at(square, 1) < 0; }
  /// Whether all of its plane over the square lies beyond the other's.
  [[nodiscard]] bool is_beyond(const CellDepth& other, const Square& square) const;

  struct Columns {
    int first, last;  ///< none if first > last
  };
  /// The cells of row y that the triangle covers whole, of those from `all.first` to `all.last`.
  [[nodiscard]] Columns covered(int y, Columns all) const;

  /// a * x + b * y + c, in cells from a square's corner on: below 0 is surely outside of a side.
  struct Side {
    float a = 0, b = 0, c = 1;
  };
  [[nodiscard]] Side side(int k, const glm::dvec2& corner) const;
  /// In the same way at least how near the triangle's plane is, by nearness(), in a square no larger than a cell.
  [[nodiscard]] Side plane(const glm::dvec2& corner) const;

 private:
  /// A function that is linear over the grid.
  struct Linear {
    double at_0 = 0, by_x = 0, by_y = 0, slack = 0;
    /// The most (side 1) or least (-1) within a square.
    [[nodiscard]] double at(const Square& s, int side) const {
      const double corner_x = s.x + (by_x * side > 0 ? s.size : 0), corner_y = s.y + (by_y * side > 0 ? s.size : 0);
      return at_0 + by_x * corner_x + by_y * corner_y + side * slack;
    }
  };
  void set_sides(const glm::dvec3 (&corners)[3], double turn);

  Linear linear_, sides_[3];  ///< the sides are positive inside
  double low_, high_;         ///< of all distances
  bool is_parallel_;
  bool has_sides_ = false, has_plane_ = false;  ///< else it is seen from too near its edge, or reaches too far
};

}  // namespace frontmost::lines_detail
