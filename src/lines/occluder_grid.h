// SPDX-License-Identifier: Apache-2.0
// Triangles by the part of the screen that they may cover, the nearest first.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "lines/welded_mesh.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A triangle on the screen: a box around it in cells' units, and its nearest distance.
struct Occluder {
  glm::vec2 low, high;
  float nearest;
  std::uint32_t triangle;
};

/// A grid of square cells over the picture.
class OccluderGrid {
 public:
  /// Of triangles that are seen from a side. O(triangles) where they are of a like size on the screen.
  OccluderGrid(const WeldedMesh& mesh, const std::vector<std::int8_t>& facing, const Sight& sight, const View& view);

  /// Calls visit(occluders of one cell) for every cell that the segment between two points of the picture passes, until
  /// it returns false.
  template <class Visit>
  void visit_cells(const glm::dvec2& from, const glm::dvec2& to, const Visit& visit) const {
    const glm::dvec2 a = from * scale_, b = to * scale_;
    const glm::dvec2& top = a.y < b.y ? a : b;
    const glm::dvec2& bottom = a.y < b.y ? b : a;
    const double slope = bottom.y > top.y ? (bottom.x - top.x) / (bottom.y - top.y) : 0;
    const int last_row = row(bottom.y + kPad);
    for (int y = row(top.y - kPad); y <= last_row; ++y) {
      const double enter = top.x + slope * (std::max(y - kPad, top.y) - top.y);
      const double leave = slope == 0 ? bottom.x : top.x + slope * (std::min(y + 1 + kPad, bottom.y) - top.y);
      const int last_column = column(std::max(enter, leave) + kPad);
      for (int x = column(std::min(enter, leave) - kPad); x <= last_column; ++x)
        if (!visit(cell(x, y))) return;
    }
  }

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
  [[nodiscard]] Outline outline_of(const WeldedMesh& mesh, const Sight& sight, std::uint32_t triangle) const;
  template <class Visit>
  void cover(const Outline& outline, const Visit& visit) const;

  [[nodiscard]] int row(double y) const { return int(std::clamp(y, 0.0, double(rows_ - 1))); }
  [[nodiscard]] int column(double x) const { return int(std::clamp(x, 0.0, double(columns_ - 1))); }
  [[nodiscard]] std::size_t number(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }
  [[nodiscard]] std::span<const Occluder> cell(int x, int y) const {
    const std::size_t i = number(x, y);
    return {occluders_.data() + first_[i], first_[i + 1] - first_[i]};
  }

  int columns_ = 1, rows_ = 1;
  glm::dvec2 scale_{1};  ///< cells a pixel
  std::vector<std::size_t> first_;
  std::vector<Occluder> occluders_;
};

}  // namespace frontmost::lines_detail
