// SPDX-License-Identifier: Apache-2.0
// The paper of a sheet: the frame with its title block, and the layout of the views in columns and rows around the
// front view. All marks are pen strokes, so plotters and DXF have them, too; texts are strokes by default.
//
//               column -1   0     1             third-angle projection: the view from a side is on that side
//    row -1                 top   iso           first-angle projection: on the opposite side
//    row  0     left     front  right  back
//    row  1              bottom
#pragma once

#include <string>
#include <vector>

#include "base/decimal.h"
#include "frontmost/sheets.h"

namespace frontmost::detail {

/// The pen that draws a stroke.
[[nodiscard]] inline const Pen& pen_of(const Stroke& stroke, const LinePens& pens) {
  if (stroke.is_hidden) return pens.hidden;
  if (stroke.is_outline) return pens.outline;
  return stroke.kind == EdgeKind::crease ? pens.crease : pens.seen;
}

/// Letters that do not look like digits.
inline constexpr std::string_view clear_letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";

/// A rectangle of the page, in millimetres.
using PageBox = DrawingBounds;

/// An arrowhead, three pen widths wide and `length` millimetres long: two triangles so slender that the pen fills them.
inline void add_arrowhead(PageGroup& group, const glm::dvec2& tip, const glm::dvec2& pointing, double length) {
  const double width = group.pen.width;
  const glm::dvec2 base = tip - length * pointing, across(-pointing.y * width, pointing.x * width);
  const glm::dvec2 corners[] = {tip, base - 1.5 * across, base - 0.5 * across,
                                tip, base + 0.5 * across, base + 1.5 * across};
  group.add(corners, true);
}

/// The text of a number with at most `digits` significant digits, without trailing zeros: "0.25", "1e+07".
[[nodiscard]] inline std::string number_text(double value, int digits = 6) { return general_text(value, digits); }

/// The text of two side lengths: "210 x 297".
[[nodiscard]] inline std::string size_text(const glm::dvec2& size, int digits = 6) {
  return number_text(size.x, digits) + " x " + number_text(size.y, digits);
}

/// The space for views: the rectangle from `low` to `high` without the title block in its lower right corner.
struct DrawingSpace {
  glm::dvec2 low{0}, high{0};
  glm::dvec2 block{0};  ///< upper left corner of the title block
};

/// The smallest page with room for a frame, in millimetres.
inline constexpr glm::dvec2 least_framed_page{210, 100};

/// The drawing space by ISO 5457: margins are 20 mm on the left and 10 mm elsewhere; the title block is 180 x 36 mm.
/// \throws Error bad_argument for a page smaller than least_framed_page.
[[nodiscard]] DrawingSpace drawing_space(const glm::dvec2& page);

/// The layer "8 frame" for a page of that size: frame (0.7 mm), zones of 50 mm from the middle with letters and
/// numbers, centring marks, trimming marks, title block and its text. Zones are only above and on the right if a side
/// is at most 210 mm. \throws Error as drawing_space() does.
[[nodiscard]] PageLayer draw_frame(const glm::dvec2& page, const TitleBlock& block,
                                   Lettering lettering = Lettering::strokes);

/// The extent of a view around its anchor, in millimetres at scale 1:1, y down, and its cell. Anchors of a row have the
/// same height, those of a column the same x.
struct ViewCell {
  glm::dvec2 low{0}, high{0};
  int column = 0, row = 0;
  /// Millimetres of paper for annotations, at any scale: left and above (before), right and below (behind).
  glm::dvec2 room_before{0}, room_behind{0};
};

/// The cell of a named view relative to the front view.
[[nodiscard]] glm::ivec2 cell_of(NamedView view, ProjectionMethod method);

/// Arranges views in columns and rows, each as wide as its widest view.
class SheetLayout {
 public:
  /// `gap` is the distance between columns and between rows, in millimetres at any scale. Precondition: there are
  /// cells.
  SheetLayout(const std::vector<ViewCell>& cells, const glm::dvec2& gap);
  /// The layout of these views with another gap.
  [[nodiscard]] SheetLayout with_gap(const glm::dvec2& gap) const { return {cells_, gap}; }

  [[nodiscard]] glm::dvec2 size(double scale) const { return extent_ * scale + gaps_; }
  /// The largest scale at which the layout fits into `area`; 1 if the layout has no size.
  [[nodiscard]] double largest_scale(const glm::dvec2& area) const;
  [[nodiscard]] const glm::dvec2& gap() const { return gap_; }
  /// The number of columns and rows in use.
  [[nodiscard]] glm::dvec2 counts() const { return {lines_[0].size(), lines_[1].size()}; }
  /// The places of the anchors. `corner` is the layout's upper left corner.
  [[nodiscard]] std::vector<glm::dvec2> anchors(double scale, const glm::dvec2& corner) const;
  /// Whether no view reaches into the corner of the page to the right of `block` and below it.
  [[nodiscard]] bool leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const;

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

/// Chooses the page, the scale and the places of the views. Views avoid the title block and are spread evenly if there
/// is room. If a scale is given but no page, the smallest of A4 to A0 that has room is taken. `has_scale` is false in
/// perspective. \throws Error when the drawing does not fit; the message says what would.
[[nodiscard]] SheetPlan plan_sheet(const SheetLayout& layout, const SheetOptions& options, bool has_scale);

}  // namespace frontmost::detail
