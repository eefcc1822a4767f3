// SPDX-License-Identifier: Apache-2.0
// frontmost lines: hidden-line drawings on paper, from model to file, with reports and warnings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/json.h"
#include "cli/lines/sheet_settings.h"
#include "cli/outputs.h"
#include "cli/settings.h"
#include "cli/stopwatch.h"
#include "cli/view/up_axis.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr std::array<std::string_view, edge_kind_count> edge_kind_names = {"boundary", "silhouette", "border", "crease",
                                                                           "intersection"};

Json view_json(const DrawnView& view, const std::string& name) {
  std::array<std::size_t, edge_kind_count> edges{};
  for (const DrawnEdge& edge : view.drawing.edges) ++edges[std::size_t(edge.kind)];
  Json kinds = Json::object();
  for (std::size_t i = 0; i < edges.size(); ++i) kinds[std::string(edge_kind_names[i])] = edges[i];
  double seen = 0, hidden = 0;
  for (const DrawnPart& part : view.drawing.parts)
    (part.hidden_by != 0 ? hidden : seen) += glm::distance(part.from, part.to) * view.placed.millimetres_per_pixel;
  return {{"name", name},
          {"edges", view.drawing.edges.size()},
          {"edges_by_kind", kinds},
          {"parts", view.drawing.parts.size()},
          {"strokes", view.placed.strokes.strokes.size()},
          {"covered_strokes", view.placed.strokes.covered},
          {"centre_lines", view.placed.centre_lines.size()},
          {"visible_mm", seen},
          {"hidden_mm", hidden}};
}

/// Returns the report of a sheet. `page` is the page of the sheet as written.
Json lines_json(const Settings& settings, const Sheet& sheet, const Page& page, const StepTimes& times) {
  Json json = {{"model", settings.model}, {"page_mm", {page.width, page.height}}};
  json["scale"] = sheet.scale ? Json(*sheet.scale) : Json(nullptr);
  json["scale_text"] = sheet.scale ? Json(scale_text(*sheet.scale)) : Json(nullptr);
  json["views"] = Json::array();
  for (const DrawnView& view : sheet.views)
    json["views"].push_back(view_json(view, view.name.empty() ? view_name(settings.view) : view.name));
  json["layers"] = Json::array();
  for (const PageLayer& layer : page.layers) {
    const PenTravel one = travel_of({page.width, page.height, "", {layer}});
    json["layers"].push_back({{"name", layer.name}, {"paths", one.paths}, {"drawn_mm", one.down}});
  }
  const PenTravel all = travel_of(page);
  json["paths"] = all.paths;
  json["points"] = all.points;
  json["arcs"] = all.arcs;
  json["drawn_mm"] = all.down;
  json["moved_mm"] = all.up;
  json["texts"] = all.texts;
  json["outputs"] = settings.drawing.outputs;
  json["timings_ms"] = {{"lines", times.milliseconds().at("views")},
                        {"rounds", times.milliseconds().at("rounds")},
                        {"strokes", times.milliseconds().at("layout")},
                        {"tones", times.milliseconds().at("tones")},
                        {"write", times.milliseconds().at("page")}};
  return json;
}

void check_outputs_of(const Settings& settings) {
  const DrawingSettings& s = settings.drawing;
  if (s.outputs.empty() && !settings.run.json) throw UsageError("nothing to do: give -o FILE or --json");
  for (const std::string& path : s.outputs) {
    const std::optional<PageFormat> format = page_format(path);
    if (!s.format && !format)
      throw UsageError(path == "-" ? "-o -: needs --format"
                                   : path + ": the suffix names no format; use .svg, .pdf, .dxf or .json");
  }
  if (s.format) check_given_format(s.outputs, int(*s.format), "svg|pdf|dxf|json");
  const bool takes_output = std::find(s.outputs.begin(), s.outputs.end(), "-") != s.outputs.end();
  if (takes_output && settings.run.json)
    throw UsageError("--json and the output '-' both write to standard output; give a file");
}

std::optional<PageFormat> format_of(const std::string& path, const DrawingSettings& settings) {
  return page_format(path) ? page_format(path) : settings.format;
}

/// Writes all outputs. DXF files get `page`, because programs that read them know line types. Other files get
/// `plotted`, which has real dashes for plotters.
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

/// Names a single object after its file in STL files, which hold only object names that programs invent.
void name_object(Scene& scene) {
  if (scene.source.format == ModelFormat::stl && scene.instances.size() == 1) scene.instances[0].name = scene.name;
}

/// Returns warnings about objects with open outlines.
std::vector<std::string> open_outlines(const Sheet& sheet) {
  std::vector<std::string> warnings;
  for (const DrawnView& view : sheet.views) {
    if (!view.section) continue;
    std::size_t open = 0, objects = 0;
    for (const CutFace& face : view.section->faces) {
      open += face.open_count;
      objects += face.open_count > 0;
    }
    if (open == 0) continue;
    warnings.push_back(
        fmt::format("section {}: {} outlines are not closed, on {} of {} objects, because the mesh is open there; "
                    "these parts are not hatched",
                    view.name, open, objects, view.section->faces.size()));
  }
  return warnings;
}

/// Returns a warning about strokes that were left out because they lie in the ink of longer strokes, if there are any.
std::optional<std::string> covered_warning(const Sheet& sheet) {
  std::size_t covered = 0;
  for (const DrawnView& view : sheet.views) covered += view.placed.strokes.covered;
  if (covered == 0) return std::nullopt;
  return fmt::format("{}, in the ink of longer strokes; a smaller --pen draws {}",
                     covered == 1 ? "1 stroke is left out" : fmt::format("{} strokes are left out", covered),
                     covered == 1 ? "it" : "more of them");
}

void warn_of(const Sheet& sheet, const Surfaces& surfaces, const Settings& settings, Progress& progress) {
  const auto warn = [&](const std::vector<std::string>& texts) { show_warnings(texts, settings.run, progress); };
  if (sheet.is_empty) warn({"nothing of the model is in view; the drawing is empty"});
  if (const auto lying = up_warning(settings.view, settings.load, surfaces)) warn({*lying});
  if (const auto hint = unit_hint(settings.drawing, surfaces, sheet.scale.value_or(0))) warn({*hint});
  warn(open_outlines(sheet));
  if (const auto covered = covered_warning(sheet)) warn({*covered});
  if (sheet.left_out > 0)
    warn({fmt::format(
        "{} diameters, radii, positions and steps are left out for lack of room; use a larger --page or fewer "
        "views (on any page, a sheet has at most 64 diameters and radii, and a row 16 steps)",
        sheet.left_out)});
  if (sheet.undrawn > 0)
    warn(
        {fmt::format("cylinders without a diameter, because no view along their axis shows them, and none from the "
                     "side states it: {}",
                     sheet.undrawn)});
  if (sheet.prisms > 0)
    warn({fmt::format("cylinders of 7 to 17 sides count as prisms and get no diameter: {}", sheet.prisms)});
}

/// Draws one model and writes its own files. Adds its page to `pages` if a file holds all sheets. \returns the report.
Json draw_model(const Settings& settings, std::vector<Page>& pages, const Execution& execution, Progress& progress) {
  std::vector<std::string> written = settings.drawing.outputs;
  written.insert(written.end(), settings.drawing.books.begin(), settings.drawing.books.end());
  Scene scene = load_model(settings, execution, progress, written);
  name_object(scene);
  const Surfaces surfaces(scene, execution);
  StepTimes times(execution);
  const Sheet sheet = draw_from_settings(settings, surfaces, times.execution());
  warn_of(sheet, surfaces, settings, progress);
  std::optional<Page> dashed;
  if (settings.drawing.sheet.plot) dashed = with_real_dashes(sheet.page, execution);
  const Page& plotted = dashed ? *dashed : sheet.page;
  write(sheet.page, plotted, settings, execution);
  times.begin("done");
  progress.clear();
  if (!settings.drawing.books.empty()) pages.push_back(plotted);
  return lines_json(settings, sheet, plotted, times);
}

/// Moves from `outputs` to `books` the files that hold the sheets of all models, each sheet on a page. \throws
/// UsageError if a file can hold only one sheet.
void part_outputs(DrawingSettings& sheet) {
  std::vector<std::string> own;
  for (const std::string& path : sheet.outputs) {
    if (sheet.count == 1 || path.find("{model}") != std::string::npos) {
      own.push_back(path);
    } else if (format_of(path, sheet) == PageFormat::pdf) {
      sheet.books.push_back(path);
    } else {
      throw UsageError(fmt::format(
          "-o {}: every model has a sheet of its own; put {{model}} into the name, or write a .pdf, which has pages",
          path));
    }
  }
  sheet.outputs = std::move(own);
}

/// Returns the settings of each model's sheet. A sheet has files of its own, or is a page of a common file. \throws
/// UsageError if a file would be written twice.
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
    sheet.drawing.number = int(sheets.size());
    sheet.drawing.count = int(models.size());
    part_outputs(sheet.drawing);
    for (std::string& path : sheet.drawing.outputs)
      paths.push_back(path = fill_template(path, model_name(model), view));
    for (std::string& path : sheet.drawing.books) path = fill_template(path, {}, view);
  }
  // At a scale that is known, triangles of CAD files leave their surface by no more than a thin pen shows.
  constexpr double millimetres_on_paper = 0.02;
  for (Settings& sheet : sheets)
    if (const auto scale = sheet.drawing.sheet.scale; scale && sheet.load.import.tolerance == 0)
      sheet.load.import.tolerance = std::max(0.001, millimetres_on_paper / *scale);
  const std::vector<std::string>& books = sheets.front().drawing.books;
  paths.insert(paths.end(), books.begin(), books.end());
  check_outputs(paths, input_files(given));
  return sheets;
}

}  // namespace

int run_lines(const Settings& settings) {
  check_drawing_settings(settings);
  check_outputs_of(settings);
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
