// SPDX-License-Identifier: Apache-2.0
// frontmost visible: every face of which a part is seen, in one view or in many.
//
//   one view        visible_faces()      of every face that is seen its areas
//   --views FILE \  faces_ever_seen()    of every face that is ever seen in how many views, and its largest share
//   --sphere N   /
#include <fmt/format.h>
#include <frontmost/table.h>
#include <frontmost/version.h>
#include <frontmost/visible_faces.h>

#include <algorithm>
#include <filesystem>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/json.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/render/jobs.h"
#include "cli/stopwatch.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr Option visible_options[] = {
    {"views", 0, "FILE",
     "Look from many places: the views of a batch file (see frontmost(1)), whose outputs are left aside.", Group::faces,
     for_visible, [](Settings& s, const Given& g) { s.visible.views = g.file_name(); }},
    {"sphere", 0, "N", "Look from N places, 1 to 100000, spread evenly all around what is framed.", Group::faces,
     for_visible,
     [](Settings& s, const Given& g) {
       s.visible.sphere = g.integer({1, 100000});
     }},
    {"output", 'o', "FILE", "The faces that are seen, as a table: .csv or .npy; - is standard output, as CSV.",
     Group::output, for_visible | may_repeat,
     [](Settings& s, const Given& g) { s.visible.outputs.push_back(g.file_name()); }},
};

TableFormat table_format(const std::string& path) {
  if (path == "-") return TableFormat::csv;
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix != ".csv" && suffix != ".npy") throw UsageError(path + ": the suffix names no format; use .csv or .npy");
  return suffix == ".csv" ? TableFormat::csv : TableFormat::npy;
}

bool writes_standard_output(const VisibleSettings& s) {
  return std::find(s.outputs.begin(), s.outputs.end(), "-") != s.outputs.end();
}

void check(const Settings& settings) {
  const VisibleSettings& s = settings.visible;
  const ViewSettings& v = settings.view;
  if (s.views && s.sphere) throw UsageError("--views and --sphere are two ways to say it");
  if (s.sphere && (v.named || v.position || v.direction || v.pose || v.pose_file || v.camera_index))
    throw UsageError("--sphere looks from all around: nothing else may say from where");
  if (settings.run.json && writes_standard_output(s))
    throw UsageError("--json and an output to - both want standard output");
  for (const std::string& path : s.outputs) (void)table_format(path);
  check_view_settings(v);
  check_outputs(s.outputs, input_files(settings));
}

/// What is looked from, before any model is known.
std::vector<ViewSettings> places_of(const Settings& settings) {
  std::vector<ViewSettings> places;
  if (!settings.visible.views) return {settings.view};
  for (const Settings& one : read_batch(*settings.visible.views, settings)) {
    try {
      check_view_settings(one.view);
      if (one.view.camera_model != CameraModel::pinhole || one.view.tessellation_error)
        throw UsageError("faces are the model's triangles, seen by pinhole cameras alone");
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: views[{}]: {}", *settings.visible.views, places.size(), error.what()));
    }
    places.push_back(one.view);
  }
  return places;
}

/// Views along `count` directions that wind from below the model to above it: each turns on by a golden angle, so that
/// all are about equally far from their neighbours.
std::vector<View> views_around(const ViewSettings& settings, const Surfaces& surfaces, int count) {
  constexpr double golden_angle = 2.3999632297286533;
  const glm::dvec3 up = direction(surfaces.scene().up), side = {up.y, up.z, up.x}, third = glm::cross(up, side);
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const double height = (2.0 * i + 1) / count - 1, around = std::sqrt(1 - height * height);
    ViewSettings one = settings;
    one.direction = up * -height + (side * std::cos(golden_angle * i) + third * std::sin(golden_angle * i)) * around;
    views.push_back(resolve_view(one, surfaces));
  }
  return views;
}

std::vector<View> views_of(const Settings& settings, const std::vector<ViewSettings>& places,
                           const Surfaces& surfaces) {
  if (settings.visible.sphere) return views_around(settings.view, surfaces, *settings.visible.sphere);
  std::vector<View> views;
  views.reserve(places.size());
  for (const ViewSettings& place : places) views.push_back(resolve_view(place, surfaces));
  return views;
}

/// A column for what every row holds.
template <class Value, class Rows, class Of>
TableColumn column(const char* name, const Rows& rows, const Of& of) {
  std::vector<Value> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(of(row));
  return {name, std::move(values)};
}

/// Which faces the rows are of: the number of all, the object's, and that within the object.
template <class Rows>
Table table_of_ids(const Rows& rows, const Surfaces& surfaces) {
  using Row = typename Rows::value_type;
  const auto number = [](const Row& row) { return row.id; };
  const auto object = [&](const Row& row) { return surfaces.source(row.id).instance; };
  const auto triangle = [&](const Row& row) { return surfaces.source(row.id).triangle; };
  return {{column<std::uint32_t>("primitive", rows, number), column<std::uint32_t>("object", rows, object),
           column<std::uint32_t>("triangle", rows, triangle)}};
}

Table table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces) {
  Table table = table_of_ids(faces, surfaces);
  table.columns.push_back(column<double>("pixels", faces, [](const VisibleFace& f) { return f.pixels; }));
  table.columns.push_back(column<double>("area", faces, [](const VisibleFace& f) { return f.area; }));
  table.columns.push_back(column<double>("solid_angle", faces, [](const VisibleFace& f) { return f.solid_angle; }));
  return table;
}

Table table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces) {
  Table table = table_of_ids(faces, surfaces);
  table.columns.push_back(column<std::uint32_t>("views", faces, [](const SeenFace& f) { return f.view_count; }));
  table.columns.push_back(column<std::uint32_t>("best_view", faces, [](const SeenFace& f) { return f.best_view; }));
  table.columns.push_back(column<double>("largest_share", faces, [](const SeenFace& f) { return f.largest_share; }));
  table.columns.push_back(column<double>("largest_pixels", faces, [](const SeenFace& f) { return f.largest_pixels; }));
  return table;
}

/// What was found, as JSON has it and as text.
struct FacesFound {
  Table table;
  Json json;
  std::string text;
};

std::string count_text(std::size_t seen, std::size_t all, const char* adverb) {
  return fmt::format("{} of {} faces {}seen, {} not\n", grouped(seen), grouped(all), adverb, grouped(all - seen));
}

FacesFound look_once(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const std::vector<VisibleFace> faces = visible_faces(surfaces, view, execution).faces;
  double pixels = 0, smallest = std::numeric_limits<double>::infinity();
  for (const VisibleFace& face : faces) {
    pixels += face.pixels;
    smallest = std::min(smallest, face.pixels);
  }
  const double rest = std::max(0.0, double(view.pixel_count()) - pixels);
  std::string text =
      fmt::format("{} x {} pixels: {:.3f} see a face, {:.3f} see none\n", view.width, view.height, pixels, rest) +
      count_text(faces.size(), surfaces.primitive_count(), "");
  if (!faces.empty()) text += fmt::format("the smallest part covers {:.3g} pixels\n", smallest);
  const Json json = {
      {"width", view.width}, {"height", view.height}, {"faces", surfaces.primitive_count()}, {"seen", faces.size()},
      {"pixels", pixels},    {"background", rest},    {"smallest", finite_or_null(smallest)}};
  return {table_of(faces, surfaces), json, text};
}

FacesFound look_often(const Surfaces& surfaces, const std::vector<View>& views, const Execution& execution) {
  const std::vector<SeenFace> faces = faces_ever_seen(surfaces, views, execution);
  const std::string text = fmt::format("{} view{}: {}", grouped(views.size()), views.size() == 1 ? "" : "s",
                                       count_text(faces.size(), surfaces.primitive_count(), "ever "));
  const Json json = {{"views", views.size()}, {"faces", surfaces.primitive_count()}, {"seen", faces.size()}};
  return {table_of(faces, surfaces), json, text};
}

void write(const Table& table, const std::string& path) {
  stop_if_interrupted();
  const WritingFiles writing;
  save(table, path, table_format(path));
}

}  // namespace

std::span<const Option> visible_option_table() { return visible_options; }

int run_visible(const Settings& settings) {
  check(settings);
  const VisibleSettings& s = settings.visible;
  const std::vector<ViewSettings> places = places_of(settings);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, s.outputs);
  const Surfaces surfaces(scene, execution);
  const std::vector<View> views = views_of(settings, places, surfaces);
  if (!s.views) show_framing_warning(settings, surfaces, progress);
  const Stopwatch watch;
  const FacesFound found =
      s.views || s.sphere ? look_often(surfaces, views, execution) : look_once(surfaces, views.front(), execution);
  const double time = watch.milliseconds();
  progress.clear();
  for (const std::string& path : s.outputs) write(found.table, path);
  if (settings.run.json) {
    Json json = {{"frontmost", FRONTMOST_VERSION}, {"model", settings.model}};
    json.update(found.json);
    json["files"] = s.outputs;
    json["timings_ms"] = {{"visible", time}};
    print(dump(json));
  } else if (!writes_standard_output(s)) {
    print(found.text);
  }
  return exit_done;
}

}  // namespace frontmost::cli
