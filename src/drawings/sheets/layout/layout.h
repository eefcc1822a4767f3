// SPDX-License-Identifier: Apache-2.0
// The layout of a sheet's views in columns and rows around the front view, with its size and scale.
//
//               column -1   0     1             third-angle projection: the view from a side is on that side
//    row -1                 top   iso           first-angle projection: on the opposite side
//    row  0     left     front  right  back
//    row  1              bottom
//
// Views in line share an axis: anchors of a row have the same height, so an edge has the same height in all of them.
#pragma once

#include <string>
#include <vector>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// The extent of a view around its anchor, in millimetres at scale 1:1, y down, and its cell. Views in line share the
/// row or the column. Anchors of a row have the same height, those of a column the same x.
struct ViewCell {
  glm::dvec2 low{0}, high{0};
  int column = 0, row = 0;
  /// Millimetres of paper for annotations, at any scale: left and above (before), right and below (behind).
  glm::dvec2 room_before{0}, room_behind{0};
};

/// The cell of a named view relative to the front view. The view from the left is on the right in first-angle
/// projection, and on the left in third-angle projection.
[[nodiscard]] glm::ivec2 cell_of(NamedView view, ProjectionMethod method);

/// The columns and rows in use, each as wide as its widest view.
class SheetLayout {
 public:
  /// Precondition: not empty. `gap` is in millimetres at any scale, between columns and between rows.
  SheetLayout(const std::vector<ViewCell>& cells, const glm::dvec2& gap);
  /// The layout of these views with another gap.
  [[nodiscard]] SheetLayout with_gap(const glm::dvec2& gap) const { return {cells_, gap}; }

  [[nodiscard]] glm::dvec2 size(double scale) const { return extent_ * scale + gaps_; }
  /// The largest scale at which the layout fits into `area`; 1 if it has no size.
  [[nodiscard]] double largest_scale(const glm::dvec2& area) const;
  [[nodiscard]] const glm::dvec2& gap() const { return gap_; }
  /// The number of columns and rows in use.
  [[nodiscard]] glm::dvec2 counts() const { return {lines_[0].size(), lines_[1].size()}; }
  /// Whether no view extends beyond `block` to the right and downwards. `corner` is the layout's upper left corner.
  [[nodiscard]] bool leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const;
  /// The places of the anchors. `corner` is the layout's upper left corner.
  [[nodiscard]] std::vector<glm::dvec2> anchors(double scale, const glm::dvec2& corner) const;

 private:
  /// A column or row in use, with its number and the extent of its views before and behind their anchors.
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

/// A sheet whose size and scale are final.
struct SheetPlan {
  glm::dvec2 size{0};
  double scale = 1;
  std::vector<glm::dvec2> anchors;
};

/// Plans the sheet. Views avoid the title block and are spread evenly if there is room. A given scale without a page
/// takes the smallest of A4 to A0 that has room. `has_scale` is false in perspective.
/// \throws Error when the drawing does not fit; the message says what would.
[[nodiscard]] SheetPlan plan_sheet(const SheetLayout& layout, const SheetOptions& options, bool has_scale);

}  // namespace frontmost::detail
