// SPDX-License-Identifier: Apache-2.0
// From the options of a sheet to its page:
//
//    camera --> surfaces (tessellated again if curved, cut for a section) --> lines --> cells
//           --> plan: paper, scale, places --> strokes, hatching, dimensions, frame --> Page
//
// Lines are found before the scale is known, because the drawn lines determine how much room a view takes. Everything
// measured in millimetres of paper comes after the plan: tolerances of strokes, dashes, hatching, numbers.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frontmost/view.h"
#include "rounds/found_rounds.h"
#include "sheets/dimensions/dimensions.h"
#include "sheets/paper.h"
#include "sheets/planned_view.h"
#include "view/tessellate/level.h"

namespace frontmost {
namespace {

using namespace detail;

constexpr double gap_between_views = 15;     // millimetres
constexpr double page_rim = 5;               // millimetres in which printers do not print
constexpr double centre_overshoot = 3;       // millimetres of centre lines beyond their rounds
constexpr double inch = 25.4;                // millimetres
constexpr glm::ivec2 fine_grid{3840, 2160};  // pixels: the shape of render()'s default pictures, for the same camera
constexpr double fine_error = 0.2;           // in pixels of that grid: about 0.01 mm on a sheet of A4
constexpr double coarsest_error = 10;
constexpr double most_fine_triangles = 2e6;  // this many take seconds to draw

bool has_named_views(const SheetOptions& options) { return !options.views.empty() || !options.sections.empty(); }

/// Whether a view looks at the model at an angle and shows nothing in true length.
bool is_at_an_angle(NamedView direction) {
  return direction == NamedView::iso || direction == NamedView::three_quarter;
}

[[noreturn]] void refuse_option(const std::string& field, const std::string& reason) {
  throw Error(ErrorCode::bad_argument, field, reason);
}

void check_range(const char* field, std::optional<double> value, double least, double most) {
  // Written so that NaN fails.
  if (value && !(*value >= least && *value <= most))
    refuse_option(field, "must be from " + number_text(least) + " to " + number_text(most));
}

std::string quoted(NamedView view) { return std::string("'").append(view_name(view)).append("'"); }

void check_each_once(const char* field, const std::vector<NamedView>& views) {
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (views[i] == views[k]) refuse_option(field, quoted(views[i]) + " is there twice");
      if (is_at_an_angle(views[i]) && is_at_an_angle(views[k]))
        refuse_option(field, quoted(views[k]) + " and " + quoted(views[i]) + " have one place");
    }
}

void check_named_views(const SheetOptions& o) {
  check_each_once("views", o.views);
  if (!o.hidden_views) return;
  check_each_once("hidden_views", *o.hidden_views);
  if (o.hidden == HiddenLines::none) refuse_option("hidden_views", "needs hidden lines, dashed or thin");
  for (const NamedView view : *o.hidden_views)
    if (std::find(o.views.begin(), o.views.end(), view) == o.views.end())
      refuse_option("hidden_views", std::string(view_name(view)) + " is not among the views");
}

void check_section_views(const SheetOptions& o) {
  if (o.sections.empty()) return;
  if (o.sections.size() > clear_letters.size())
    refuse_option("sections", std::to_string(clear_letters.size()) + " are the most");
  for (std::size_t i = 0; i < o.sections.size(); ++i) {
    const SectionView& section = o.sections[i];
    if (is_at_an_angle(section.direction))
      refuse_option("sections", quoted(section.direction) + " looks along no axis");
    if (section.at && !std::isfinite(*section.at)) refuse_option("sections", "the position of a plane must be finite");
    for (std::size_t k = 0; k < i; ++k)
      if (section.direction == o.sections[k].direction && section.at == o.sections[k].at)
        refuse_option("sections", quoted(section.direction) + " is there twice at one place");
  }
  if (o.style == DrawingStyle::figure) refuse_option("sections", "figures have none");
  if (o.hatch || o.stipple)
    refuse_option("sections", "hatching marks the cut faces of sections; leave out hatch and stipple");
}

void check_paper(const SheetOptions& o) {
  if (!o.page) return;
  if (!o.page->fits_drawing) {
    check_range("page", o.page->size.x, 1, 1e5);
    check_range("page", o.page->size.y, 1, 1e5);
  } else if (o.title_block) {
    refuse_option("page", "a frame needs a page of a given size, not one fitted to the drawing");
  } else if (!o.scale) {
    refuse_option("page", "a page fitted to the drawing needs a scale");
  }
}

/// Refuses options that a drawing of a given view in this projection cannot have.
void validate_for_view(const SheetOptions& o, const Projection& projection) {
  if (has_named_views(o)) refuse_option("views", "the view is given; draw_sheet() draws named ones");
  if (o.hidden_views) refuse_option("hidden_views", "the view is given; needs named ones");
  if (projection.orthographic) return;
  if (o.scale || o.standard_scale.value_or(false)) refuse_option("scale", "a perspective view has no scale");
  if (o.centre_lines.value_or(false)) refuse_option("centre_lines", "perspective has none");
}

/// Millimetres per unit of length of the model.
double millimetres_per_unit(const SheetOptions& options, const Scene& scene) {
  return options.millimetres_per_unit.value_or(1000 * scene.source.metres_per_unit.value_or(0.001));
}

/// Whether the sheet states its dimensions in inches.
bool is_in_inches(const SheetOptions& options, const Scene& scene) {
  return options.in_inches.value_or(std::abs(millimetres_per_unit(options, scene) - inch) < 1e-9);
}

/// The pens of the style, scaled to the given width.
LinePens pens_of(const SheetOptions& options) {
  LinePens pens = options.style == DrawingStyle::figure ? figure_pens() : technical_pens();
  if (options.hidden == HiddenLines::thin) pens.hidden = thin_pen();
  if (!options.pen) return pens;
  const double factor = *options.pen / pens.seen.width;
  for (Pen* const pen :
       {&pens.outline, &pens.seen, &pens.crease, &pens.hidden, &pens.hatching, &pens.stippling, &pens.centre}) {
    pen->width *= factor;
    for (double& dash : pen->dashes) dash *= factor;  // standards count dashes in widths
  }
  return pens;
}

bool wants_centre_lines(const SheetOptions& options) {
  return options.centre_lines.value_or(has_named_views(options) && options.style == DrawingStyle::technical);
}

/// The finest error that paper shows, or a coarser one, if that takes too many triangles; none if all do.
std::optional<double> tessellation_error(const SheetOptions& options, const Scene& scene, const View& view) {
  if (options.tessellation_error) return options.tessellation_error;
  for (double error = fine_error; error <= coarsest_error; error *= 2)
    if (tessellated_count(scene, view, error) <= most_fine_triangles) return error;
  return std::nullopt;
}

/// The triangles of `surfaces`, tessellated again for the view if they are curved.
std::shared_ptr<const Surfaces> surfaces_for(const Surfaces& surfaces, const View& view, const SheetOptions& options,
                                             const Execution& execution) {
  std::optional<double> error;
  if (has_curved(surfaces.scene())) error = tessellation_error(options, surfaces.scene(), view);
  if (!error) return {std::shared_ptr<void>(), &surfaces};
  return surfaces_of(std::make_shared<const Scene>(tessellate(surfaces.scene(), view, *error)), execution);
}

/// Whether a view shows hidden lines. By default, views at an angle do not, because hidden lines would obscure the
/// shape.
bool shows_hidden(const SheetOptions& options, NamedView direction) {
  if (options.hidden == HiddenLines::none) return false;
  if (!options.hidden_views) return !is_at_an_angle(direction);
  return std::find(options.hidden_views->begin(), options.hidden_views->end(), direction) !=
         options.hidden_views->end();
}

/// Draws the lines of a view whose surfaces and camera are known, of a model in this scene.
void draw_lines_of(PlannedView& planned, LineDrawer& drawer, const Scene& scene, const SheetOptions& options,
                   const Execution& execution) {
  const LineOptions wanted{
      .crease_angle = options.crease_angle, .ripples = false, .outlines = options.style == DrawingStyle::figure};
  planned.drawing = drawer.draw(planned.drawing.view, wanted, execution);
  const View& view = planned.drawing.view;
  const Projection& p = view.projection;
  if (p.orthographic)
    planned.millimetres_per_pixel = (p.right - p.left) / view.width * millimetres_per_unit(options, scene);
}

/// A view without its lines.
PlannedView plan_named(const Surfaces& surfaces, NamedView direction, const SectionView* section,
                       std::span<const UncutObject> uncut, const SheetOptions& options, const Execution& execution) {
  View view = frame(surfaces, fine_grid.x, fine_grid.y,
                    {.direction = direction, .orthographic = true, .objects = FramedObjects::all});
  ClipDistances& planes = view.projection.clip;
  const ClipDistances fitted = planes;  // they enclose the model
  planes = {options.near.value_or(fitted.near), options.far.value_or(fitted.far)};
  if (!(planes.near < planes.far) && !(options.near && options.far))
    refuse_option(options.near ? "near" : "far", "leaves nothing of the " + std::string(view_name(direction)) +
                                                     " view, in which the model lies from " +
                                                     number_text(fitted.near, 3) + " to " + number_text(fitted.far, 3));
  PlannedView result;
  result.direction = direction;
  result.shows_hidden = !section && shows_hidden(options, direction);
  result.surfaces = surfaces_for(surfaces, view, options, execution);
  if (section) cut_surfaces(result, *section, uncut, view, execution);
  result.drawing.view = view;
  return result;
}

/// The views of the options, then the sections, without places.
std::vector<PlannedView> draw_named_views(const Surfaces& surfaces, const SheetOptions& options,
                                          const Execution& execution) {
  std::vector<PlannedView> views;
  LineDrawer whole(surfaces);
  const auto draw_lines_in = [&](PlannedView& view) {
    if (view.surfaces.get() == &surfaces) return draw_lines_of(view, whole, surfaces.scene(), options, execution);
    LineDrawer own(*view.surfaces);
    draw_lines_of(view, own, surfaces.scene(), options, execution);
  };
  for (const NamedView direction : options.views) {
    PlannedView& view = views.emplace_back(plan_named(surfaces, direction, nullptr, {}, options, execution));
    view.name = view.placed.name = view_name(direction);
    draw_lines_in(view);
  }
  std::vector<UncutObject> uncut;
  if (!options.sections.empty()) uncut = uncut_objects(surfaces, options.uncut, execution);
  for (std::size_t i = 0; i < options.sections.size(); ++i) {
    const SectionView& section = options.sections[i];
    PlannedView& view =
        views.emplace_back(plan_named(surfaces, section.direction, &section, uncut, options, execution));
    view.letter = clear_letters[i];
    view.name = view.placed.name = view.letter + "-" + view.letter;
    draw_lines_in(view);
  }
  return views;
}

/// Finds the rounds of the views that need them, once for views of the same surfaces.
void find_rounds_of(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution) {
  // Dimensions need rounds, too.
  if (options.dimensions == Dimensioning::none && !wants_centre_lines(options)) return;
  for (std::size_t i = 0; i < views.size(); ++i) {
    // A named view at an angle shows no round along its axis.
    if (views[i].direction && is_at_an_angle(*views[i].direction)) continue;
    for (std::size_t k = 0; k < i && !views[i].rounds; ++k)
      if (views[k].surfaces == views[i].surfaces) views[i].rounds = views[k].rounds;
    if (!views[i].rounds) views[i].rounds = std::make_shared<const Rounds>(find_rounds(*views[i].surfaces, execution));
  }
}

/// The cells of the views, whose anchors are set: views in line have theirs in the middle of the model.
std::vector<ViewCell> cells_of(std::vector<PlannedView>& views, const Surfaces& surfaces, const SheetOptions& options) {
  const glm::dvec3 low(surfaces.bounds().low), high(surfaces.bounds().high);
  const glm::dvec3 middle = surfaces.bounds().is_empty() ? glm::dvec3(0) : low + (high - low) * 0.5;
  std::vector<ViewCell> cells;
  for (PlannedView& view : views) {
    const View& camera = view.drawing.view;
    DrawingBounds box = bounds_of(view.drawing, view.shows_hidden);
    if (options.keeps_picture || box.is_empty()) box = {glm::dvec2(0), glm::dvec2(camera.width, camera.height)};
    ViewCell& cell = cells.emplace_back();
    view.anchor = (box.low + box.high) * 0.5;
    if (view.direction) {
      const glm::ivec2 place = cell_of(*view.direction, options.projection);
      cell.column = place.x;
      cell.row = place.y;
      if (!is_at_an_angle(*view.direction)) view.anchor = on_screen(camera, middle);
    }
    cell.low = (box.low - view.anchor) * view.millimetres_per_pixel;
    cell.high = (box.high - view.anchor) * view.millimetres_per_pixel;
    if (view.rounds && !view.rounds->rounds.empty()) cell.room_before = cell.room_behind = glm::dvec2(centre_overshoot);
  }
  return cells;
}

constexpr double usual_crease = std::numbers::pi / 6;  // grazing angle of intersections without a crease angle
constexpr double plotted_stroke = 0.5;                 // millimetres: the shortest stroke worth a pen's movement
constexpr double paper_tolerance = 0.01;               // millimetres: for arcs, and for lines that count as one
constexpr double stroke_tolerance = 0.0005;            // millimetres: half of the rounding unit of coordinates
constexpr double shortest_hatch = 0.2;                 // millimetres: shorter hatch lines are dots of the pen
constexpr double plotted_gap = 0.05;                   // millimetres: a plotter's pen draws across smaller gaps

/// Shortest stroke of an edge, millimetres of paper.
double shortest_stroke(const SheetOptions& options) {
  return options.shortest_stroke.value_or(options.plot ? plotted_stroke : 0);
}

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
  strokes.shortest = std::min(shortest_stroke(options) / millimetres, 1e4);
  strokes.arc_tolerance = std::min(paper_tolerance / millimetres, 100.0);
  // The round ends of two strokes cover the gap between them.
  const double gap = options.plot ? plotted_gap : pens_of(options).seen.width / 2;
  strokes.joining = std::min(gap / millimetres, 100.0);
  if (!options.plot) return strokes;
  strokes.ink_reach = [pens = pens_of(options), millimetres](const Stroke& stroke) {
    const Pen& pen = pen_of(stroke, pens);
    return pen.dashes.empty() ? std::min(pen.width / 2 / millimetres, 1000.0) : 0.0;
  };
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

/// \throws Error limit_exceeded if the view has too few pixels for hatching or dots.
void place_tones(PlannedView& view, const SheetOptions& options, const Execution& execution) {
  const View& camera = view.drawing.view;
  const double millimetres = view.placed.millimetres_per_pixel;
  if (options.hatch) {
    check_spacing("hatch", *options.hatch, millimetres);
    const double shortest = std::max(shortest_hatch, shortest_stroke(options));
    const HatchOptions lines{hatch_sets(*options.hatch / millimetres, options.hatch_angle),
                             tone_options(options, camera), std::min(shortest / millimetres, 1000.0), !options.plot,
                             options.plot};
    view.placed.hatching = hatch(*view.surfaces, camera, lines, execution);
  }
  if (options.stipple) {
    constexpr double most_dots = 2e7;  // the limit of stipple()
    const double least = std::max(1.0, std::sqrt(double(camera.width) * camera.height / most_dots));
    check_spacing("stipple", *options.stipple, least * millimetres);
    const StippleOptions dots{*options.stipple / millimetres, tone_options(options, camera), !options.plot,
                              options.plot};
    view.placed.stippling = stipple(*view.surfaces, camera, dots, execution);
  }
}

std::vector<DimensionedView> dimensioned_views(const std::vector<PlannedView>& views) {
  std::vector<DimensionedView> all;
  for (const PlannedView& planned : views) {
    // A section does not show the size of the whole model.
    const bool is_dimensioned = !is_at_an_angle(*planned.direction) && !planned.section;
    all.push_back({&planned.placed, &planned.drawing, planned.rounds.get(), planned.surfaces.get(), is_dimensioned,
                   planned.taken});
  }
  return all;
}

DimensionOptions dimension_options(const SheetOptions& options, const Scene& scene) {
  const bool in_inches = is_in_inches(options, scene);
  DimensionOptions numbers;
  numbers.numbers_per_unit = millimetres_per_unit(options, scene) / (in_inches ? inch : 1);
  numbers.number_style = {in_inches ? 3 : 2, in_inches && options.inch_fractions};
  numbers.level = options.dimensions;
  numbers.lettering = options.lettering;
  return numbers;
}

/// Sets the places of the views. \returns the plan.
SheetPlan place_views(std::vector<PlannedView>& views, const Surfaces& surfaces, const SheetOptions& options) {
  std::vector<ViewCell> cells = cells_of(views, surfaces, options);
  place_sections(cells, views);
  keep_section_room(cells, views);
  std::vector<OverallSizes> sizes(views.size());
  const std::vector<DimensionedView> dimensioned = dimensioned_views(views);
  if (options.dimensions != Dimensioning::none) sizes = overall_sizes_of(dimensioned);
  const DimensionOptions numbers = dimension_options(options, surfaces.scene());
  const std::vector<glm::dvec2> positions = position_rooms_of(dimensioned, numbers);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const glm::dvec2 room = room_for(sizes[i], positions[i], numbers.text_height);
    if (room.x > 0) cells[i].room_before.x = std::max(cells[i].room_before.x, views[i].taken.x + room.x);
    if (room.y > 0) cells[i].room_behind.y = std::max(cells[i].room_behind.y, views[i].taken.y + room.y);
  }
  const bool has_scale = views[0].drawing.view.projection.orthographic;
  SheetPlan plan = plan_sheet(SheetLayout(cells, glm::dvec2(gap_between_views)), options, has_scale);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SheetView& placed = views[i].placed;
    placed.millimetres_per_pixel = views[i].millimetres_per_pixel * plan.scale;
    placed.origin = plan.anchors[i] - views[i].anchor * placed.millimetres_per_pixel;
  }
  return plan;
}

/// Adds dimensions to the page. They stay away from `marks`, and from the page's rim, or from the frame and the title
/// block if these will be added.
void add_dimensions(Sheet& sheet, const std::vector<PlannedView>& views, const std::vector<PageBox>& marks,
                    const Scene& scene, const SheetOptions& options) {
  const glm::dvec2 size(sheet.page.width, sheet.page.height);
  PageBox area{glm::dvec2(page_rim), size - page_rim};
  std::vector<PageBox> taken = marks;
  if (options.title_block) {
    const DrawingSpace space = drawing_space(size);
    area = {space.low, space.high};
    taken.push_back({space.block, space.high});
  }
  Dimensions all = place_dimensions(dimensioned_views(views), area, taken, dimension_options(options, scene));
  if (all.count > 0) sheet.page.layers.push_back(std::move(all.layer));
  sheet.left_out = all.left_out;
  sheet.undrawn = all.undrawn;
  sheet.prisms = all.prisms;
}

void add_frame(Page& page, const SheetOptions& options, const Scene& scene, std::optional<double> scale) {
  TitleBlock block = *options.title_block;
  page.title = block.title;
  block.scale = scale ? scale_text(*scale) : "\xE2\x80\x93";  // a dash: views in perspective have no scale
  block.unit = is_in_inches(options, scene) ? "in" : "mm";
  block.paper = paper_name({page.width, page.height});
  block.projection = has_named_views(options) ? options.projection : ProjectionMethod::none;
  page.layers.push_back(draw_frame({page.width, page.height}, block, options.lettering));
}

Sheet finish(std::vector<PlannedView> views, const Surfaces& surfaces, const SheetOptions& options,
             const Execution& execution) {
  report_progress(execution, "rounds", 0);
  find_rounds_of(views, options, execution);
  report_progress(execution, "layout", 0);
  const SheetPlan plan = place_views(views, surfaces, options);
  for (PlannedView& view : views)
    view.placed.strokes = chain_strokes(*view.surfaces, view.drawing, stroke_options(view, options), execution);
  report_progress(execution, "tones", 0);
  hatch_sections(views, options, execution);
  for (PlannedView& view : views) {
    place_tones(view, options, execution);
    if (!view.rounds || !wants_centre_lines(options)) continue;
    const double overshoot = std::min(centre_overshoot / view.placed.millimetres_per_pixel, 1e6);
    view.placed.centre_lines =
        centre_lines_of(*view.rounds, view.drawing, view.placed.strokes, {view.shows_hidden, overshoot});
  }
  report_progress(execution, "page", 0);
  const LinePens pens = pens_of(options);
  std::vector<SheetView> placed;
  for (const PlannedView& view : views) placed.push_back(view.placed);
  Sheet sheet;
  sheet.page = page_of(surfaces, placed, pens, plan.size);
  sheet.is_empty = sheet.page.layers.empty();
  if (views[0].drawing.view.projection.orthographic) sheet.scale = plan.scale;
  SectionMarks marks = section_marks_of(views, pens.centre, options.lettering);
  if (!marks.layer.groups.empty()) sheet.page.layers.push_back(std::move(marks.layer));
  if (options.dimensions != Dimensioning::none) add_dimensions(sheet, views, marks.boxes, surfaces.scene(), options);
  if (options.title_block) add_frame(sheet.page, options, surfaces.scene(), sheet.scale);
  for (PlannedView& view : views) sheet.views.push_back(std::move(view));
  return sheet;
}

}  // namespace

std::string_view view_name(NamedView view) {
  constexpr std::string_view names[] = {"front", "back", "left", "right", "top", "bottom", "iso", "three-quarter"};
  return names[int(view)];
}

void validate(const SheetOptions& o) {
  check_range("pen", o.pen, 0.01, 10);
  check_range("crease_angle", o.crease_angle, 0, std::numbers::pi);
  check_range("shortest_stroke", o.shortest_stroke, 0, 10);
  check_range("margin", o.margin, 0, 1000);
  check_range("scale", o.scale, 1e-12, 1e12);
  check_range("millimetres_per_unit", o.millimetres_per_unit, 1e-12, 1e12);
  check_range("hatch", o.hatch, 0.2, 50);
  check_range("hatch_angle", o.hatch_angle, -100, 100);
  check_range("stipple", o.stipple, 0.2, 10);
  check_range("tessellation_error", o.tessellation_error, 1e-3, 1e3);
  check_named_views(o);
  check_paper(o);
  if (o.dimensions != Dimensioning::none && o.views.empty()) refuse_option("dimensions", "need views");
  check_section_views(o);
  if (o.plot && o.lettering == Lettering::text) refuse_option("lettering", "plotters have no fonts; use strokes");
}

Sheet draw_sheet(const Surfaces& surfaces, const SheetOptions& options, const Execution& execution) {
  validate(options);
  if (!has_named_views(options)) throw Error(ErrorCode::bad_argument, "views", "there is none, nor a section");
  report_progress(execution, "views", 0);
  return finish(draw_named_views(surfaces, options, execution), surfaces, options, execution);
}

Sheet draw_view(const Surfaces& surfaces, const View& view, const SheetOptions& options, const Execution& execution) {
  validate(options);
  validate_for_view(options, view.projection);
  report_progress(execution, "views", 0);
  std::vector<PlannedView> views(1);
  views[0].surfaces = surfaces_for(surfaces, view, options, execution);
  views[0].shows_hidden = options.hidden != HiddenLines::none;
  views[0].drawing.view = view;
  LineDrawer drawer(*views[0].surfaces);
  draw_lines_of(views[0], drawer, surfaces.scene(), options, execution);
  return finish(std::move(views), surfaces, options, execution);
}

}  // namespace frontmost
