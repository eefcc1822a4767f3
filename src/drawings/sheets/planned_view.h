// SPDX-License-Identifier: Apache-2.0
// Views of a sheet on their way from the camera to their places on the page, and what the options of the sheet mean for
// them.
//
//    draw_named_views --> drawing, in pixels of its own picture
//    cells_of, plan   --> placed: the view's origin on the page and its millimetres per pixel
//    place_...        --> strokes, tones and centre lines of `placed`
//
// A view is filled in that order; what a step needs of the one before is there when it begins.
#pragma once

#include "frontmost/lines.h"
#include "sheets/layout/layout.h"

namespace frontmost::detail {

/// How far centre lines reach beyond what they are drawn for, in millimetres.
inline constexpr double centre_overshoot = 3;

[[nodiscard]] inline bool has_named_views(const SheetOptions& options) {
  return !options.views.empty() || !options.sections.empty();
}
[[nodiscard]] inline bool wants_centre_lines(const SheetOptions& options) {
  return options.centre_lines.value_or(has_named_views(options) && options.style == DrawingStyle::technical);
}
/// Of the model's unit of length.
[[nodiscard]] double millimetres_per_unit(const SheetOptions& options, const Scene& scene);
inline constexpr double inch = 25.4;  ///< millimetres
/// Whether the sheet states its dimensions in inches.
[[nodiscard]] bool is_in_inches(const SheetOptions& options, const Scene& scene);
/// The pens of the style, as wide as asked for.
[[nodiscard]] LinePens pens_of(const SheetOptions& options);
/// \throws Error bad_argument: "field: reason".
[[noreturn]] void refuse_option(const std::string& field, const std::string& reason);
/// \throws Error bad_argument for what a drawing in this projection, of no named views, cannot have.
void validate_for_view(const SheetOptions& options, const Projection& projection);

struct PlannedView : DrawnView {
  std::optional<NamedView> direction;    ///< none where the view was given
  CuttingPlane plane;                    ///< of a section
  std::string letter;                    ///< likewise: "A"
  double millimetres_per_pixel = 1;      ///< at scale 1:1; in perspective of no meaning by itself
  std::shared_ptr<const Rounds> rounds;  ///< of the surfaces; null where nothing asks for them
  /// Millimetres of paper on its left and below it that marks of sections take.
  glm::dvec2 taken{0};
};

/// Whether a view looks at the model at an angle, and shows nothing in its true length.
[[nodiscard]] inline bool is_at_an_angle(NamedView direction) {
  return direction == NamedView::iso || direction == NamedView::three_quarter;
}

/// The views of the options, then the sections, each with its lines and without a place.
/// \throws Error as draw_sheet() does.
[[nodiscard]] std::vector<PlannedView> draw_named_views(const Surfaces& surfaces, const SheetOptions& options,
                                                        const Execution& execution);
/// A view that is given, likewise.
[[nodiscard]] PlannedView draw_given_view(const Surfaces& surfaces, const View& view, const SheetOptions& options,
                                          const Execution& execution);

/// Finds what is round in the views that are to show it: once for those that draw the same surfaces.
void find_rounds_of(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution);

/// What the views take of the page, and the pixel of each about which its cell stands.
struct Cells {
  std::vector<ViewCell> cells;
  std::vector<glm::dvec2> anchors;
};
[[nodiscard]] Cells cells_of(const std::vector<PlannedView>& views, const Surfaces& surfaces,
                             const SheetOptions& options);

// Of a view whose place on the page is settled.
void place_strokes(PlannedView& view, const SheetOptions& options, const Execution& execution);
/// Hatching and dots, where they are asked for. \throws Error limit_exceeded where its pixels are too few for them.
void place_tones(PlannedView& view, const SheetOptions& options, const Execution& execution);
/// Beside strokes, which must be there.
void place_centre_lines(PlannedView& view, const SheetOptions& options);

}  // namespace frontmost::detail
