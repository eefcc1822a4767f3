// SPDX-License-Identifier: Apache-2.0
// Views of a sheet: strokes, hatching and centre lines in their places on a page, with pens as drawing standards have
// them.
//
//   Drawing --chain_strokes()--> Strokes ----+
//   hatch(), stipple(), centre_lines_of() ----+--> SheetView --page_of()--> Page --save()--> file
//                                                  a place and a scale
//
// draw_sheet() does all of it; these are the steps, for those who lay out pages of their own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontmost/hatching.h"
#include "frontmost/page.h"
#include "frontmost/rounds.h"
#include "frontmost/strokes.h"

namespace frontmost {

/// Pens by what they draw.
struct LinePens {
  Pen outline{0.5, {}};  ///< where the scene ends, seen
  Pen seen{0.5, {}};     ///< all other lines that are seen
  Pen crease{0.5, {}};   ///< of those, creases; by themselves where strokes were made by kind
  Pen hidden{0.25, {}, {3, 0.75}};
  Pen hatching{0.18, {}};
  Pen stippling{0.3, {}};  ///< its width is that of the dots
  /// Long dashes and dots. Each line has an odd number of dashes, made longer or shorter so that it begins, ends and
  /// has its middle in one; a short one is whole.
  Pen centre{0.25, {}, {6, 1, 0.1, 1}};
};
/// ISO 128: what is seen 0.5 mm, hidden lines 0.25 mm in dashes of 3 mm with gaps of 0.75 mm, centre lines 0.25 mm in
/// dashes of about 6 mm with a dot between two.
[[nodiscard]] LinePens technical_pens();
/// For people: an outline of 0.7 mm, contours within it of 0.35 mm, creases of 0.18 mm, hidden lines of 0.13 mm.
[[nodiscard]] LinePens figure_pens();
/// Hidden lines that are thin (0.13 mm) instead of dashed.
[[nodiscard]] Pen thin_pen();

/// One view of a sheet.
struct SheetView {
  std::string name;  ///< in front of objects' names; may be empty
  Strokes strokes;
  glm::dvec2 origin{0};  ///< millimetres: where the view's pixel (0, 0) begins
  double millimetres_per_pixel = 1;
  std::vector<HatchLine> hatching{};
  std::vector<Stipple> stippling{};
  std::vector<CentreLine> centre_lines{};

  [[nodiscard]] glm::dvec2 on_page(const glm::dvec2& pixel) const { return origin + millimetres_per_pixel * pixel; }
};

/// A page with the layers "5 stippling", "4 hatching", "6 centre lines", "1 hidden", "2 visible" and "3 outline", those
/// that have lines, the lowest first. Each has a group for every view and object, named as they are; in the order of
/// the strokes and of the hatching. Centre lines have groups by their dashes, without names.
[[nodiscard]] Page page_of(const Surfaces& surfaces, std::span<const SheetView> views, const LinePens& pens,
                           const glm::dvec2& size);

/// What the parts of a drawing cover, hidden ones only where asked for: low and high corner, in pixels. Low is greater
/// than high where there is nothing.
struct DrawingBounds {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
};
[[nodiscard]] DrawingBounds bounds_of(const Drawing& drawing, bool with_hidden);

}  // namespace frontmost
