// SPDX-License-Identifier: Apache-2.0
// frontmost lines: hidden-line drawings on paper, from the camera to the file.
#include <fmt/format.h>
#include <frontmost/curved.h>
#include <frontmost/tessellate.h>

#include <algorithm>
#include <optional>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/interruption.h"
#include "cli/lines/centres.h"
#include "cli/lines/layout.h"
#include "cli/lines/lines_report.h"
#include "cli/lines/sections.h"
#include "cli/lines/sizes.h"
#include "cli/lines/titles.h"
#include "cli/lines/tones.h"
#include "cli/lines/units.h"
#include "cli/model.h"
#include "cli/outputs.h"
#include "cli/render/fit.h"
#include "cli/stopwatch.h"
#include "cli/view_options.h"

namespace frontmost::cli {
namespace {

constexpr double usual_crease = 30;          // degrees: of intersections
constexpr double plotted_stroke = 0.5;       // millimetres: the shortest that is worth the pen's way
constexpr double gap_between_views = 15;     // millimetres
constexpr double paper_tolerance = 0.01;     // millimetres: of arcs, and of lines that count as one
constexpr double stroke_tolerance = 0.0005;  // millimetres: half of what coordinates are rounded to
constexpr glm::ivec2 fine_grid{3840, 2160};  // shaped as render's default picture, for the same camera
constexpr double fine_error = 0.2;           // of its pixels: about 0.01 mm on a sheet of A4
constexpr double coarsest_error = 10;
constexpr double most_fine_triangles = 2e6;  // seconds to draw

bool is_parallel(const Settings& s) { return s.view.orthographic || s.drawing.is_sheet(); }

void check_hidden_views(const DrawingSettings& s) {
  if (!s.hidden_views) return;
  if (s.hidden == DrawingSettings::Hidden::none) throw UsageError("--hidden-views needs --hidden dashed or thin");
  for (const NamedView view : *s.hidden_views)
    if (std::find(s.views.begin(), s.views.end(), view) == s.views.end())
      throw UsageError(fmt::format("--hidden-views: {} is not among --views", view_name(view)));
}

void check_views(const Settings& s) {
  if (s.drawing.views.empty() && s.drawing.hidden_views) throw UsageError("--hidden-views needs --views");
  if (!s.drawing.is_sheet()) {
    if (s.drawing.layout) throw UsageError("--projection needs --views");
    return;
  }
  const char* const sheet = s.drawing.views.empty() ? "--sections" : "--views";
  const ViewSettings& v = s.view;
  const std::pair<const char*, bool> others[] = {{"view", v.named.has_value()},
                                                 {"camera-position", v.position.has_value()},
                                                 {"camera-focal-point", v.focal_point.has_value()},
                                                 {"camera-direction", v.direction.has_value()},
                                                 {"camera-view-up", v.view_up.has_value()},
                                                 {"camera-view-angle", v.view_angle.has_value()},
                                                 {"camera-zoom-factor", v.zoom != 1},
                                                 {"camera-azimuth-angle", v.azimuth != 0},
                                                 {"camera-elevation-angle", v.elevation != 0},
                                                 {"camera-index", v.camera_index.has_value()},
                                                 {"intrinsics", v.intrinsics.has_value()},
                                                 {"pose", v.pose.has_value()},
                                                 {"resolution", v.resolution.has_value()}};
  for (const auto& [name, is_set] : others)
    if (is_set) throw UsageError(fmt::format("{} and --{} exclude each other", sheet, name));
}

void check(const Settings& settings) {
  const DrawingSettings& s = settings.drawing;
  check_view_settings(settings.view);
  check_views(settings);
  check_hidden_views(s);
  check_frame(s);
  check_tones(s);
  check_centres(settings);
  check_dimensions(s);
  check_sections(s);
  if (s.outputs.empty() && !settings.run.json) throw UsageError("nothing to do: give -o FILE or --json");
  if (s.scale_rule && s.scale_rule != ScaleRule::fit && !is_parallel(settings))
    throw UsageError("--scale: in perspective nothing has a scale; add --camera-orthographic, or --views");
  if (s.paper && s.paper->fits_drawing && s.scale_rule != ScaleRule::given)
    throw UsageError("--page fit: needs a --scale such as 1:5");
  for (const std::string& path : s.outputs) {
    const std::optional<PageFormat> format = page_format(path);
    if (!s.format && !format)
      throw UsageError(path == "-" ? "-o -: needs --format"
                                   : path + ": the suffix names no format; use .svg, .pdf, .dxf or .json");
  }
  if (s.format) check_given_format(s.outputs, int(*s.format), "svg|pdf|dxf|json");
  const bool takes_output = std::find(s.outputs.begin(), s.outputs.end(), "-") != s.outputs.end();
  if (takes_output && settings.run.json) throw UsageError("--json and an output to - both want standard output");
}

/// True when the user chose what is in the picture, beyond the direction from where the model is seen.
bool is_framed(const ViewSettings& s) {
  return s.pose || s.camera_index || s.position || s.intrinsics || s.resolution || s.zoom != 1;
}

/// As fine as paper shows it, or coarser where the eye is so near that this is beyond measure. None where no fineness
/// that looks well can be had: the model's own triangles look better.
std::optional<double> tessellation_error(const ViewSettings& settings, const Scene& scene, const View& view) {
  if (settings.tessellation_error) return settings.tessellation_error;
  for (double error = fine_error; error <= coarsest_error; error *= 2)
    if (tessellated_count(scene, view, error) <= most_fine_triangles) return error;
  return std::nullopt;
}

/// A drafter's view at an angle shows what the thing looks like, and hidden edges would only hide that.
bool shows_hidden(const DrawingSettings& settings, std::optional<NamedView> view) {
  if (settings.hidden == DrawingSettings::Hidden::none) return false;
  if (!view || settings.views.empty()) return true;
  if (!settings.hidden_views) return *view != NamedView::iso;
  return std::find(settings.hidden_views->begin(), settings.hidden_views->end(), *view) != settings.hidden_views->end();
}

/// Lets the view show the triangles of `surfaces`, made anew where they are curved.
void take_surfaces(DrawnView& result, const ViewSettings& settings, const Surfaces& surfaces, const View& view,
                   const Execution& execution) {
  result.surfaces = &surfaces;
  std::optional<double> error;
  if (has_curved(surfaces.scene())) error = tessellation_error(settings, surfaces.scene(), view);
  if (!error) return;
  result.tessellated = std::make_unique<const Scene>(tessellate(surfaces.scene(), view, *error));
  result.own = std::make_unique<const Surfaces>(*result.tessellated, execution);
  result.surfaces = result.own.get();
}

/// `section` is its number in the settings, where the view is one.
DrawnView draw(const ViewSettings& settings, const Settings& all, const Surfaces& surfaces,
               std::optional<std::size_t> section, const Execution& execution) {
  DrawnView result;
  const View view = resolve_view(settings, surfaces);
  take_surfaces(result, settings, surfaces, view, execution);
  if (section) cut_view(result, *result.surfaces, all.drawing, *section, view, execution);
  LineOptions options;
  if (all.drawing.crease_angle) options.crease_angle = glm::radians(*all.drawing.crease_angle);
  options.outlines = all.drawing.style == DrawingSettings::Style::figure;
  result.drawing = draw_lines(*result.surfaces, view, options, execution);
  result.millimetres_per_unit = unit_of(all.drawing, surfaces.scene().source);
  const Projection& p = view.projection;
  if (p.orthographic) result.millimetres_per_pixel = (p.right - p.left) / view.width * result.millimetres_per_unit;
  result.shows_hidden = !section && shows_hidden(all.drawing, settings.named);
  return result;
}

std::vector<DrawnView> draw_all(const Settings& settings, const Surfaces& surfaces, const Execution& execution) {
  ViewSettings one = settings.view;
  if (!one.resolution && !one.intrinsics) one.resolution = fine_grid;
  std::vector<DrawnView> views;
  if (!settings.drawing.is_sheet()) {
    views.push_back(draw(one, settings, surfaces, std::nullopt, execution));
    views.back().name = view_name(settings.view);
    views.back().keeps_frame = is_framed(settings.view);
    return views;
  }
  one.orthographic = true;
  const auto add = [&](NamedView named, std::optional<std::size_t> section) {
    one.named = named;
    DrawnView& view = views.emplace_back(draw(one, settings, surfaces, section, execution));
    view.named = named;
    view.name = view.sheet.name = view.cut ? fmt::format("{0}-{0}", view.cut->letter) : std::string(view_name(named));
  };
  for (const NamedView named : settings.drawing.views) add(named, std::nullopt);
  for (std::size_t i = 0; i < settings.drawing.sections.size(); ++i) add(settings.drawing.sections[i].view, i);
  return views;
}

/// The pixel that views in line share: the middle of the model.
glm::dvec2 middle_pixel(const View& view, const Surfaces& surfaces) {
  const glm::dvec3 offset = visible_bounds(surfaces).centre - view.eye();
  const Projection& p = view.projection;
  return {(glm::dot(offset, view.right()) - p.left) / (p.right - p.left) * view.width,
          (p.top - glm::dot(offset, view.up())) / (p.top - p.bottom) * view.height};
}

/// What a view covers, and the pixel that its cell stands about.
struct Frame {
  ViewCell cell;
  glm::dvec2 anchor{0};
};

Frame frame_of(const DrawnView& view, const Settings& settings, const Surfaces& surfaces) {
  const View& camera = view.drawing.view;
  DrawingBounds box = bounds_of(view.drawing, view.shows_hidden);
  if (view.keeps_frame || box.is_empty()) {
    box.low = glm::dvec2(0);
    box.high = glm::dvec2(camera.width, camera.height);
  }
  Frame frame;
  frame.anchor = (box.low + box.high) * 0.5;
  if (view.named) {
    const glm::ivec2 cell =
        cell_of(*view.named, settings.drawing.layout.value_or(DrawingSettings::Layout::first_angle));
    frame.cell.column = cell.x;
    frame.cell.row = cell.y;
    if (*view.named != NamedView::iso) frame.anchor = middle_pixel(camera, surfaces);
  }
  frame.cell.low = (box.low - frame.anchor) * view.millimetres_per_pixel;
  frame.cell.high = (box.high - frame.anchor) * view.millimetres_per_pixel;
  if (view.rounds && !view.rounds->rounds.empty())
    frame.cell.room_before = frame.cell.room_behind = glm::dvec2(centre_overshoot);
  return frame;
}

/// Lays the views out. \returns the plan; the views know their places from now on.
SheetPlan place(std::vector<DrawnView>& views, const Settings& settings, const Surfaces& surfaces) {
  std::vector<Frame> frames;
  std::vector<ViewCell> cells;
  for (const DrawnView& view : views) {
    frames.push_back(frame_of(view, settings, surfaces));
    cells.push_back(frames.back().cell);
  }
  place_sections(cells, views);
  keep_section_room(cells, views);
  keep_room(cells, views, settings);
  SheetPlan plan = plan_sheet(Layout(cells, glm::dvec2(gap_between_views)), settings.drawing, is_parallel(settings));
  for (std::size_t i = 0; i < views.size(); ++i) {
    SheetView& sheet = views[i].sheet;
    sheet.millimetres_per_pixel = views[i].millimetres_per_pixel * plan.scale;
    sheet.origin = plan.anchors[i] - frames[i].anchor * sheet.millimetres_per_pixel;
  }
  return plan;
}

StrokeOptions stroke_options(const DrawingSettings& settings, const DrawnView& view) {
  const double millimetres_per_pixel = view.sheet.millimetres_per_pixel;
  StrokeOptions options;
  options.with_hidden = view.shows_hidden;
  options.grazing_angle = glm::radians(std::min(settings.crease_angle.value_or(usual_crease), 90.0));
  options.by_kind = options.by_outline = settings.style == DrawingSettings::Style::figure;
  options.by_instance = !settings.plot;
  options.nearest_first = settings.plot;
  options.apart = std::clamp(paper_tolerance / millimetres_per_pixel, 0.002, 1.0);
  options.tolerance = std::clamp(stroke_tolerance / millimetres_per_pixel, 1e-4, 1.0);
  options.shortest =
      std::min(settings.shortest_stroke.value_or(settings.plot ? plotted_stroke : 0) / millimetres_per_pixel, 1e4);
  options.arc_tolerance = std::min(paper_tolerance / millimetres_per_pixel, 100.0);
  return options;
}

LinePens pens_of(const DrawingSettings& settings) {
  LinePens pens = settings.style == DrawingSettings::Style::figure ? figure_pens() : technical_pens();
  if (settings.hidden == DrawingSettings::Hidden::thin) pens.hidden = thin_pen();
  if (!settings.pen) return pens;
  const double factor = *settings.pen / pens.seen.width;
  for (Pen* const pen :
       {&pens.outline, &pens.seen, &pens.crease, &pens.hidden, &pens.hatching, &pens.stippling, &pens.centre}) {
    pen->width *= factor;
    for (double& dash : pen->dashes) dash *= factor;  // standards count dashes in widths
  }
  return pens;
}

std::optional<PageFormat> format_of(const std::string& path, const DrawingSettings& settings) {
  return page_format(path) ? page_format(path) : settings.format;
}

/// Plotters follow paths. DXF is for programs that know line types.
void write(const Page& page, const Page& plotted, const Settings& settings, const Execution& execution) {
  for (const std::string& path : settings.drawing.outputs) {
    stop_if_interrupted();
    const WritingFiles writing;
    const auto format = format_of(path, settings.drawing);
    save(format == PageFormat::dxf ? page : plotted, path, format, execution);
  }
}

void write_books(const std::vector<Page>& pages, const Settings& settings, const Execution& execution) {
  for (const std::string& path : settings.drawing.books) {
    stop_if_interrupted();
    const WritingFiles writing;
    save(pages, path, format_of(path, settings.drawing), execution);
  }
}

/// An STL file has no names of objects but those that programs write: one object is named as its file is.
void name_object(Scene& scene) {
  if (scene.source.format == ModelFormat::stl && scene.instances.size() == 1) scene.instances[0].name = scene.name;
}

/// Draws one model, and writes its own files; its page goes to `pages` where some file holds all. \returns the report.
Json draw_model(const Settings& settings, std::vector<Page>& pages, const Execution& execution, Progress& progress) {
  std::vector<std::string> written = settings.drawing.outputs;
  written.insert(written.end(), settings.drawing.books.begin(), settings.drawing.books.end());
  Scene scene = load_model(settings, execution, progress, written);
  name_object(scene);
  const Surfaces surfaces(scene, execution);
  LinesTimings timings;
  Stopwatch watch;
  std::vector<DrawnView> views = draw_all(settings, surfaces, execution);
  timings.lines = watch.milliseconds();
  watch = {};
  find_rounds_of(views, settings, execution);
  timings.rounds = watch.milliseconds();
  watch = {};
  const SheetPlan plan = place(views, settings, surfaces);
  for (DrawnView& view : views) {
    const StrokeOptions options = stroke_options(settings.drawing, view);
    view.sheet.strokes = chain_strokes(*view.surfaces, view.drawing, options, execution);
  }
  timings.strokes = watch.milliseconds();
  watch = {};
  std::vector<SheetView> sheets;
  hatch_sections(views, settings, execution);
  for (DrawnView& view : views) {
    add_tones(view, settings.drawing, execution);
    add_centre_lines(view, settings.drawing);
    sheets.push_back(view.sheet);
  }
  timings.tones = watch.milliseconds();
  watch = {};
  Page page = page_of(surfaces, sheets, pens_of(settings.drawing), plan.size);
  const std::optional<double> scale = is_parallel(settings) ? std::optional(plan.scale) : std::nullopt;
  if (page.layers.empty()) show_warnings({"nothing is seen; the drawing is empty"}, settings.run, progress);
  if (const auto hint = unit_hint(settings.drawing, surfaces, plan.scale); hint && scale)
    show_warnings({*hint}, settings.run, progress);
  show_warnings(open_outlines(views), settings.run, progress);
  SectionMarks marks = marks_of(views, pens_of(settings.drawing).centre);
  if (!marks.layer.groups.empty()) page.layers.push_back(std::move(marks.layer));
  if (const std::size_t left_out = add_dimensions(page, views, marks.boxes, settings); left_out > 0)
    show_warnings({fmt::format("{} diameters had no room; take a larger --page or fewer views", left_out)},
                  settings.run, progress);
  if (settings.drawing.has_frame()) add_frame(page, settings, scale, scene.name);
  std::optional<Page> dashed;
  if (settings.drawing.plot) dashed = with_real_dashes(page, execution);
  const Page& plotted = dashed ? *dashed : page;
  write(page, plotted, settings, execution);
  timings.write = watch.milliseconds();
  progress.clear();
  Json report = lines_json(settings, views, plotted, scale, timings);
  if (!settings.drawing.books.empty()) pages.push_back(dashed ? std::move(*dashed) : std::move(page));
  return report;
}

/// Parts a sheet's files from those that hold the sheets of all models as pages. \throws UsageError where they cannot.
void part_outputs(DrawingSettings& sheet) {
  std::vector<std::string> own;
  for (const std::string& path : sheet.outputs) {
    if (sheet.sheets == 1 || path.find("{model}") != std::string::npos) {
      own.push_back(path);
    } else if (format_of(path, sheet) == PageFormat::pdf) {
      sheet.books.push_back(path);
    } else {
      throw UsageError(fmt::format(
          "-o {}: every model has a sheet of its own; put {{model}} into the name, or make it a .pdf, which has pages",
          path));
    }
  }
  sheet.outputs = std::move(own);
}

/// Every model has a sheet of its own, and files of its own or pages of one. \throws UsageError where files are to be
/// written twice.
std::vector<Settings> sheets_of(const Settings& given) {
  std::vector<std::string> models = given.more_models;
  models.insert(models.begin(), given.model);
  std::vector<Settings> sheets;
  std::vector<std::string> paths;
  const std::string view = given.drawing.is_sheet() ? std::string("sheet") : view_name(given.view);
  for (const std::string& model : models) {
    Settings& sheet = sheets.emplace_back(given);
    sheet.model = model;
    sheet.more_models.clear();
    sheet.drawing.sheet = int(sheets.size());
    sheet.drawing.sheets = int(models.size());
    part_outputs(sheet.drawing);
    for (std::string& path : sheet.drawing.outputs)
      paths.push_back(path = fill_template(path, model_name(model), view));
    for (std::string& path : sheet.drawing.books) path = fill_template(path, {}, view);
  }
  const std::vector<std::string>& books = sheets.front().drawing.books;
  paths.insert(paths.end(), books.begin(), books.end());
  check_outputs(paths, input_files(given));
  return sheets;
}

}  // namespace

int run_lines(const Settings& settings) {
  check(settings);
  const std::vector<Settings> sheets = sheets_of(settings);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  Json reports = Json::array();
  std::vector<Page> pages;
  for (const Settings& sheet : sheets) {
    if (sheets.size() > 1) progress.set_prefix(fmt::format("sheet {} of {}: ", reports.size() + 1, sheets.size()));
    reports.push_back(draw_model(sheet, pages, execution, progress));
  }
  write_books(pages, sheets.front(), execution);
  progress.clear();
  if (!settings.run.json) return exit_done;
  print(dump(sheets.size() == 1 ? reports[0] : Json{{"sheets", reports}, {"outputs", sheets.front().drawing.books}}));
  return exit_done;
}

}  // namespace frontmost::cli
