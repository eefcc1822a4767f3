// SPDX-License-Identifier: Apache-2.0
// Strokes, hatching, dots and centre lines of a view whose place on the page is final.
//
// Strokes are chained in pixels of the view, but their tolerances are lengths on paper. So they are made when the scale
// is known, and a sheet at 1:10 has no details that a pen could not draw.
//
// Details that are too short or too dense for a pen are left out here, not when a file is written, so all formats have
// the same strokes.
#include <algorithm>
#include <cmath>

#include "sheets/page_marks.h"
#include "sheets/planned_view.h"

namespace frontmost::detail {
namespace {

constexpr double usual_crease = std::numbers::pi / 6;  // of intersections
constexpr double plotted_stroke = 0.5;                 // millimetres: the shortest stroke worth a pen's movement
constexpr double paper_tolerance = 0.01;               // millimetres: for arcs, and for lines that count as one
constexpr double stroke_tolerance = 0.0005;            // millimetres: half of the rounding unit of coordinates
constexpr double shortest_hatch = 0.2;                 // millimetres: shorter hatch lines are dots of the pen

StrokeOptions stroke_options(const PlannedView& view, const SheetOptions& options) {
  const double millimetres = view.placed.millimetres_per_pixel;
  StrokeOptions strokes;
  strokes.with_hidden = view.shows_hidden;
  strokes.grazing_angle = std::min(options.crease_angle.value_or(usual_crease), std::numbers::pi / 2);
  strokes.by_kind = strokes.by_outline = options.style == DrawingStyle::figure;
  strokes.by_instance = !options.plot;
  strokes.nearest_first = options.plot;
  strokes.apart = std::clamp(paper_tolerance / millimetres, 0.002, 1.0);
  strokes.tolerance = std::clamp(stroke_tolerance / millimetres, 1e-4, 1.0);
  strokes.shortest = std::min(options.shortest_stroke.value_or(options.plot ? plotted_stroke : 0) / millimetres, 1e4);
  strokes.arc_tolerance = std::min(paper_tolerance / millimetres, 100.0);
  return strokes;
}

ToneOptions tone_options(const SheetOptions& options, const View& view) {
  ToneOptions tone;
  if (options.light) tone.to_light = glm::dmat3(view.world_from_eye) * *options.light;  // eye space looks down -z
  tone.casts_shadows = options.casts_shadows;
  if (options.crease_angle) tone.crease_angle = *options.crease_angle;
  return tone;
}

/// Checks a spacing in millimetres of paper against a limit that comes from pixels.
void check_spacing(const char* field, double spacing, double least) {
  if (spacing >= least) return;
  throw Error(ErrorCode::limit_exceeded, std::string(field),
              number_text(spacing) + " mm would be too many for so large a drawing; take " +
                  number_text(std::ceil(least * 100) / 100, 3) + " or more, or a smaller page or scale");
}

StippleOptions stipple_options(const SheetOptions& options, const View& view, double millimetres) {
  constexpr double most_dots = 2e7;  // the limit of stipple()
  const double least = std::max(1.0, std::sqrt(double(view.width) * view.height / most_dots));
  check_spacing("stipple", *options.stipple, least * millimetres);
  return {*options.stipple / millimetres, tone_options(options, view), !options.plot, options.plot};
}

HatchOptions hatch_options(const SheetOptions& options, const View& view, double millimetres) {
  check_spacing("hatch", *options.hatch, millimetres);
  HatchOptions hatching;
  hatching.sets = hatch_sets(*options.hatch / millimetres, options.hatch_angle);
  hatching.tone = tone_options(options, view);
  hatching.shortest = std::min(shortest_hatch / millimetres, 1000.0);
  hatching.by_instance = !options.plot;
  hatching.nearest_first = options.plot;
  return hatching;
}

}  // namespace

void place_strokes(PlannedView& view, const SheetOptions& options, const Execution& execution) {
  view.placed.strokes = chain_strokes(*view.surfaces, view.drawing, stroke_options(view, options), execution);
}

void place_tones(PlannedView& view, const SheetOptions& options, const Execution& execution) {
  const View& camera = view.drawing.view;
  const double millimetres = view.placed.millimetres_per_pixel;
  if (options.hatch)
    view.placed.hatching = hatch(*view.surfaces, camera, hatch_options(options, camera, millimetres), execution);
  if (options.stipple)
    view.placed.stippling = stipple(*view.surfaces, camera, stipple_options(options, camera, millimetres), execution);
}

void place_centre_lines(PlannedView& view, const SheetOptions& options) {
  if (!view.rounds || !wants_centre_lines(options)) return;
  CentreLineOptions centre;
  centre.with_hidden = view.shows_hidden;
  centre.overshoot = std::min(centre_overshoot / view.placed.millimetres_per_pixel, 1e6);
  view.placed.centre_lines = centre_lines_of(*view.rounds, view.drawing, view.placed.strokes, centre);
}

}  // namespace frontmost::detail
