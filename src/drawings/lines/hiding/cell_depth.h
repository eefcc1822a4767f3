// SPDX-License-Identifier: Apache-2.0
// A triangle over the squares of a plane: which squares it covers, and its distance within each.
//
// A triangle that covers a whole cell hides everything beyond it there. The answer comes from rounded places, so it
// leaves room for rounding: a cell counts as covered only where that is certain.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "lines/square_grid.h"

namespace frontmost::lines_detail {

/// Linear on the screen; larger values are nearer.
[[nodiscard]] inline double nearness(double distance, bool is_parallel) {
  return is_parallel ? -distance : 1 / distance;
}

/// In cells; more than the rounding error of any place in the picture.
inline constexpr double kCellPad = 1e-6;

/// Bounds that hold in spite of rounding, for a triangle that lies wholly beyond the near plane.
class CellDepth {
 public:
  /// Places have x and y in cells, and the planar distance as z. In perspective, its inverse is linear on the screen.
  CellDepth(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool is_parallel);

  /// Bounds of the triangle's distance within a square.
  [[nodiscard]] double nearest(const Square& square) const;
  [[nodiscard]] double farthest(const Square& square) const;
  struct Columns {
    int first, last;  ///< none if first > last
  };
  /// The cells of row y, from `all.first` to `all.last`, that the triangle covers whole.
  [[nodiscard]] Columns covered(int y, Columns all) const;

  /// The function a * x + b * y + c, in cells from a square's corner: negative values are certainly outside of a side.
  struct Side {
    float a = 0, b = 0, c = 1;
  };
  [[nodiscard]] Side side(int k, const glm::dvec2& corner) const;
  /// A lower bound, in the same form, of the plane's nearness() in a square no larger than a cell.
  [[nodiscard]] Side plane(const glm::dvec2& corner) const;

 private:
  /// A function that is linear over the grid.
  struct Linear {
    double at_0 = 0, by_x = 0, by_y = 0, slack = 0;
    /// The maximum (side 1) or minimum (side -1) within a square.
    [[nodiscard]] double at(const Square& s, int side) const {
      const double corner_x = s.x + (by_x * side > 0 ? s.size : 0), corner_y = s.y + (by_y * side > 0 ? s.size : 0);
      return at_0 + by_x * corner_x + by_y * corner_y + side * slack;
    }
  };
  void set_sides(const glm::dvec3 (&corners)[3], double turn);

  Linear linear_, sides_[3];  ///< the sides are positive inside
  double low_, high_;         ///< of the distances of all corners
  bool is_parallel_;
  bool has_sides_ = false, has_plane_ = false;  ///< false if the triangle is seen almost edge-on or reaches too far
};

}  // namespace frontmost::lines_detail
