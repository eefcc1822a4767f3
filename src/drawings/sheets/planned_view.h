// SPDX-License-Identifier: Apache-2.0
// The views of a sheet, from their cameras to their places on the page, and the meaning of the sheet's options for
// them.
//
//    draw_named_views --> drawing, in pixels of its own picture
//    cells_of, plan   --> placed: the view's origin on the page and its millimetres per pixel
//    place_...        --> strokes, tones and centre lines of `placed`
//
// A view is filled in that order; each step needs the results of the one before.
#pragma once

#include "frontmost/lines.h"
#include "sheets/layout/layout.h"

namespace frontmost::detail {

/// How far centre lines extend beyond their rounds, in millimetres.
inline constexpr double centre_overshoot = 3;

[[nodiscard]] inline bool has_named_views(const SheetOptions& options) {
  return !options.views.empty() || !options.sections.empty();
}
[[nodiscard]] inline bool wants_centre_lines(const SheetOptions& options) {
  return options.centre_lines.value_or(has_named_views(options) && options.style == DrawingStyle::technical);
}
/// Millimetres per unit of length of the model.
[[nodiscard]] double millimetres_per_unit(const SheetOptions& options, const Scene& scene);
inline constexpr double inch = 25.4;  ///< millimetres
/// Whether the sheet states its dimensions in inches.
[[nodiscard]] bool is_in_inches(const SheetOptions& options, const Scene& scene);
/// The pens of the style, scaled to the given width.
[[nodiscard]] LinePens pens_of(const SheetOptions& options);
/// \throws Error bad_argument: "field: reason".
[[noreturn]] void refuse_option(const std::string& field, const std::string& reason);
/// \throws Error bad_argument for options that a drawing of a given view in this projection cannot have.
void validate_for_view(const SheetOptions& options, const Projection& projection);

struct PlannedView : DrawnView {
  std::optional<NamedView> direction;    ///< empty if the view was given
  CuttingPlane plane;                    ///< of a section
  std::string letter;                    ///< of a section: "A"
  double millimetres_per_pixel = 1;      ///< at scale 1:1; meaningless by itself in perspective
  std::shared_ptr<const Rounds> rounds;  ///< of the surfaces; null if not needed
  /// Millimetres of paper on the left and below that marks of sections occupy.
  glm::dvec2 taken{0};
};

/// Whether a view looks at the model at an angle and shows nothing in true length.
[[nodiscard]] inline bool is_at_an_angle(NamedView direction) {
  return direction == NamedView::iso || direction == NamedView::three_quarter;
}

/// Draws the views of the options, then the sections, each with its lines but without a place.
/// \throws Error as draw_sheet() does.
[[nodiscard]] std::vector<PlannedView> draw_named_views(const Surfaces& surfaces, const SheetOptions& options,
                                                        const Execution& execution);
/// Draws a given view, likewise.
[[nodiscard]] PlannedView draw_given_view(const Surfaces& surfaces, const View& view, const SheetOptions& options,
                                          const Execution& execution);

/// Finds the rounds of the views that need them, once for views of the same surfaces.
void find_rounds_of(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution);

/// The cells of the views, and the pixel of each view at its cell's anchor.
struct Cells {
  std::vector<ViewCell> cells;
  std::vector<glm::dvec2> anchors;
};
[[nodiscard]] Cells cells_of(const std::vector<PlannedView>& views, const Surfaces& surfaces,
                             const SheetOptions& options);

// Steps for a view whose place on the page is final.
void place_strokes(PlannedView& view, const SheetOptions& options, const Execution& execution);
/// Adds hatching and dots if requested. \throws Error limit_exceeded if the view has too few pixels for them.
void place_tones(PlannedView& view, const SheetOptions& options, const Execution& execution);
/// Adds centre lines. Precondition: the strokes are there.
void place_centre_lines(PlannedView& view, const SheetOptions& options);

}  // namespace frontmost::detail
