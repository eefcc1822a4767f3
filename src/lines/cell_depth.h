// SPDX-License-Identifier: Apache-2.0
// What a large triangle does in the cells of a grid: which it covers, and how far away it is there.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace frontmost::lines_detail {

/// Linear on the screen, and the larger the nearer.
[[nodiscard]] inline double nearness(double distance, bool is_parallel) {
  return is_parallel ? -distance : 1 / distance;
}

/// Bounds that hold whatever rounding did, for a triangle none of which is before the near plane.
class CellDepth {
 public:
  /// Places have x and y in cells and z the planar distance. In perspective its inverse is what is linear on the
  /// screen.
  CellDepth(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool is_parallel);

  /// Bounds of its distance within cell (x, y).
  [[nodiscard]] double nearest(int x, int y) const;
  [[nodiscard]] double farthest(int x, int y) const;

  struct Columns {
    int first, last;  ///< none if first > last
  };
  /// The cells of row y that the triangle covers whole, of those from `all.first` to `all.last`.
  [[nodiscard]] Columns covered(int y, Columns all) const;

  /// a * x + b * y + c, in cells from a cell's corner on: below 0 is surely outside of a side.
  struct Side {
    float a = 0, b = 0, c = 1;
  };
  /// Of cell (x, y).
  [[nodiscard]] Side side(int k, int x, int y) const;
  /// In the same way at least how near the triangle's plane is, by nearness().
  [[nodiscard]] Side plane(int x, int y) const;

 private:
  /// A function that is linear over the grid.
  struct Linear {
    double at_0 = 0, by_x = 0, by_y = 0, slack = 0;
    /// The most (side 1) or least (-1) within a cell.
    [[nodiscard]] double at(int x, int y, int side) const {
      const double corner_x = x + double(by_x * side > 0), corner_y = y + double(by_y * side > 0);
      return at_0 + by_x * corner_x + by_y * corner_y + side * slack;
    }
  };
  void set_sides(const glm::dvec3 (&corners)[3], double turn);

  Linear linear_, sides_[3];             ///< the sides are positive inside
  double low_, high_;                    ///< of all distances
  bool is_parallel_, is_known_ = false;  ///< else it is seen from too near its edge, or reaches too far, to say more
};

}  // namespace frontmost::lines_detail
