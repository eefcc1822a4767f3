// SPDX-License-Identifier: Apache-2.0
// Where the views of a sheet stand, in columns and rows about the front one; its size and its scale.
//
//               column -1   0     1             third-angle projection: what is seen from a side stands on that side
//    row -1                 top   iso           first-angle projection: on the other side
//    row  0     left     front  right  back
//    row  1              bottom
//
// Views in line share an axis: anchors of a row are at one height, so that an edge is at the same height in all of
// them.
#pragma once

#include <string>
#include <vector>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// What a view takes around its anchor, in millimetres at scale 1:1, y down; and its cell, of which views in line share
/// the row or the column. Anchors in a row are at one height, in a column below each other.
struct ViewCell {
  glm::dvec2 low{0}, high{0};
  int column = 0, row = 0;
  /// Millimetres of paper beside it at any scale, for what is written about it: left and above, right and below.
  glm::dvec2 room_before{0}, room_behind{0};
};

/// The cell of a named view about the front view: a view from the left stands to the right in first-angle projection,
/// and to the left in third-angle projection.
[[nodiscard]] glm::ivec2 cell_of(NamedView view, ProjectionMethod method);

/// Columns and rows in use, each as wide as its widest view.
class SheetLayout {
 public:
  /// Precondition: not empty. `gap` in millimetres, at any scale, between columns and between rows.
  SheetLayout(const std::vector<ViewCell>& cells, const glm::dvec2& gap);
  /// The same views, otherwise apart.
  [[nodiscard]] SheetLayout with_gap(const glm::dvec2& gap) const { return {cells_, gap}; }

  [[nodiscard]] glm::dvec2 size(double scale) const { return extent_ * scale + gaps_; }
  /// The largest scale at which all fits into `area`; 1 where it has no size.
  [[nodiscard]] double largest_scale(const glm::dvec2& area) const;
  [[nodiscard]] const glm::dvec2& gap() const { return gap_; }
  /// How many columns and rows are in use.
  [[nodiscard]] glm::dvec2 counts() const { return {lines_[0].size(), lines_[1].size()}; }
  /// Whether no view, with the layout's upper left corner at `corner`, reaches to the right of `block` and below it.
  [[nodiscard]] bool leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const;
  /// Where the anchors are, with the layout's upper left corner at `corner`.
  [[nodiscard]] std::vector<glm::dvec2> anchors(double scale, const glm::dvec2& corner) const;

 private:
  /// Along one axis: numbers of lines in use, and how far views reach before and behind their anchors.
  struct Line {
    int number;
    double before, behind;
    double room_before = 0, room_behind = 0;
  };
  [[nodiscard]] static std::vector<Line> lines_of(const std::vector<ViewCell>& cells, int axis);
  [[nodiscard]] double place(const ViewCell& cell, int axis, double scale) const;

  std::vector<ViewCell> cells_;
  glm::dvec2 gap_;
  std::vector<Line> lines_[2];
  glm::dvec2 extent_{0}, gaps_{0};
};

/// A sheet whose size and scale are settled.
struct SheetPlan {
  glm::dvec2 size{0};
  double scale = 1;
  std::vector<glm::dvec2> anchors;
};

/// With a title block no view lies on it; where room is left views stand farther apart, evenly, and a given scale
/// without a page takes the smallest of A4 to A0 on which all has room. `has_scale` is false in perspective.
/// \throws Error when the drawing does not fit, saying what would.
[[nodiscard]] SheetPlan plan_sheet(const SheetLayout& layout, const SheetOptions& options, bool has_scale);

}  // namespace frontmost::detail
