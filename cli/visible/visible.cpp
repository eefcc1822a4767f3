// SPDX-License-Identifier: Apache-2.0
// frontmost visible: all faces that are visible at least in part, in one view or in many.
//
//   one view        visible_faces()      the areas of each visible face
//   --views FILE \  faces_ever_seen()    for each face ever seen, its number of views and its largest share
//   --sphere N   /
#include <fmt/format.h>
#include <frontmost/files.h>
#include <frontmost/report.h>
#include <frontmost/version.h>

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
#include "cli/visible/face_tables.h"

namespace frontmost::cli {
namespace {

constexpr Option visible_options[] = {
    {"views", 0, "FILE",
     "Look from all views of a batch file (see frontmost(1)); the outputs of the batch file are ignored.", Group::faces,
     for_visible, [](Settings& s, const Given& g) { s.visible.views = g.file_name(); }},
    {"sphere", 0, "N", "Look from N places, 1 to 100000, spread evenly all around the framed objects.", Group::faces,
     for_visible,
     [](Settings& s, const Given& g) {
       s.visible.sphere = g.integer({1, 100000});
     }},
    {"output", 'o', "FILE",
     "Write a table of the faces that are seen (.csv or .npy; - is standard output, as CSV), or the whole model with "
     "the visible area of every face as properties and as colour (.ply).",
     Group::output, for_visible | may_repeat,
     [](Settings& s, const Given& g) { s.visible.outputs.push_back(g.file_name()); }},
    {"keep-visible", 0, "FILE", "Write a model of only those faces that are seen: .glb, .ply or .stl.", Group::output,
     for_visible | may_repeat, [](Settings& s, const Given& g) { s.visible.kept.push_back(g.file_name()); }},
};

bool has_suffix(const std::string& path, std::initializer_list<std::string_view> suffixes) {
  const std::string suffix = std::filesystem::path(path).extension().string();
  return std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end();
}

bool is_model(const std::string& path) { return has_suffix(path, {".ply"}); }

std::vector<std::string> files_of(const VisibleSettings& s) {
  std::vector<std::string> files = s.outputs;
  files.insert(files.end(), s.kept.begin(), s.kept.end());
  return files;
}

bool writes_standard_output(const VisibleSettings& s) {
  return std::find(s.outputs.begin(), s.outputs.end(), "-") != s.outputs.end();
}

void check(const Settings& settings) {
  const VisibleSettings& s = settings.visible;
  const ViewSettings& v = settings.view;
  if (s.views && s.sphere) throw UsageError("--views and --sphere exclude each other");
  if (s.sphere && (v.named || v.position || v.direction || v.pose || v.pose_file || v.camera_index))
    throw UsageError("--sphere looks from all around, and excludes options of the camera's position and direction");
  if (settings.run.json && writes_standard_output(s))
    throw UsageError("--json and the output '-' both write to standard output; give a file");
  for (const std::string& path : s.outputs)
    if (path != "-" && !has_suffix(path, {".csv", ".npy", ".ply"}))
      throw UsageError(path + ": the suffix names no format; use .csv, .npy or .ply");
  for (const std::string& path : s.kept)
    if (!has_suffix(path, {".glb", ".ply", ".stl"}))
      throw UsageError(path + ": the suffix names no format of models; use .glb, .ply or .stl");
  check_view_settings(v);
  check_outputs(files_of(s), input_files(settings));
}

/// Returns the views' settings, checked before the model is read.
std::vector<ViewSettings> places_of(const Settings& settings) {
  std::vector<ViewSettings> places;
  if (!settings.visible.views) return {settings.view};
  for (const Settings& one : read_batch(*settings.visible.views, settings)) {
    try {
      check_view_settings(one.view);
      if (one.view.camera_model != CameraModel::pinhole || one.view.tessellation_error)
        throw UsageError("the command visible needs a pinhole camera, and excludes --tessellation-error");
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: views[{}]: {}", *settings.visible.views, places.size(), error.what()));
    }
    places.push_back(one.view);
  }
  return places;
}

/// Returns views along `count` directions on a spiral from below the model to above it. Each direction is turned by a
/// golden angle from the last one, so that all are about equally far from their neighbours.
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

/// The faces that were found, and the reports about them.
struct FacesFound {
  std::vector<PrimitiveId> ids;
  Table listed, colored;  ///< `colored` only if a model is to be written
  Json json;
  std::string text;
};

template <class Face>
FacesFound found_of(const std::vector<Face>& faces, const Surfaces& surfaces, const VisibleSettings& settings) {
  FacesFound found;
  for (const Face& face : faces) found.ids.push_back(face.id);
  found.listed = table_of(faces, surfaces);
  const std::vector<std::string>& outputs = settings.outputs;
  if (std::any_of(outputs.begin(), outputs.end(), is_model)) found.colored = colored_table_of(faces, surfaces);
  return found;
}

std::string count_text(std::size_t seen, std::size_t all, const char* adverb) {
  return fmt::format("{} of {} faces {}seen, {} not\n", grouped(seen), grouped(all), adverb, grouped(all - seen));
}

FacesFound look_once(const Surfaces& surfaces, const View& view, const VisibleSettings& settings,
                     const Execution& execution) {
  const std::vector<VisibleFace> faces = visible_faces(surfaces, view, execution).faces;
  double pixels = 0, smallest = std::numeric_limits<double>::infinity();
  for (const VisibleFace& face : faces) {
    pixels += face.pixels;
    smallest = std::min(smallest, face.pixels);
  }
  const double rest = std::max(0.0, double(view.pixel_count()) - pixels);
  FacesFound found = found_of(faces, surfaces, settings);
  found.text =
      fmt::format("{} x {} pixels: {:.3f} see a face, {:.3f} see none\n", view.width, view.height, pixels, rest) +
      count_text(faces.size(), surfaces.primitive_count(), "");
  if (!faces.empty()) found.text += fmt::format("the smallest part covers {:.3g} pixels\n", smallest);
  found.json = {
      {"width", view.width}, {"height", view.height}, {"faces", surfaces.primitive_count()}, {"seen", faces.size()},
      {"pixels", pixels},    {"background", rest},    {"smallest", finite_or_null(smallest)}};
  return found;
}

FacesFound look_often(const Surfaces& surfaces, const std::vector<View>& views, const VisibleSettings& settings,
                      const Execution& execution) {
  const std::vector<SeenFace> faces = faces_ever_seen(surfaces, views, execution);
  FacesFound found = found_of(faces, surfaces, settings);
  found.text = fmt::format("{} view{}: {}", grouped(views.size()), views.size() == 1 ? "" : "s",
                           count_text(faces.size(), surfaces.primitive_count(), "ever "));
  found.json = {{"views", views.size()}, {"faces", surfaces.primitive_count()}, {"seen", faces.size()}};
  return found;
}

void write(const std::string& path, const FacesFound& found, const Scene& scene) {
  stop_if_interrupted();
  const WritingFiles writing;
  if (is_model(path)) return save(scene, path, found.colored);
  save(found.listed, path, has_suffix(path, {".npy"}) ? TableFormat::npy : TableFormat::csv);
}

/// Writes the model of the visible faces, and adds the numbers of omitted faces and objects to the reports.
void write_kept(const std::vector<std::string>& paths, const Surfaces& surfaces, FacesFound& found) {
  if (paths.empty()) return;
  const Scene kept = keep_faces(surfaces.scene(), found.ids);
  const std::size_t objects = surfaces.scene().instances.size(), faces = surfaces.primitive_count();
  for (const std::string& path : paths) {
    stop_if_interrupted();
    const WritingFiles writing;
    save(kept, path, has_suffix(path, {".ply"}) ? origin_table_of(found.ids, surfaces) : Table());
  }
  found.json["left_out"] = {{"faces", faces - found.ids.size()}, {"objects", objects - kept.instances.size()}};
  found.text += fmt::format("{} of {} faces and {} of {} objects left out\n", grouped(faces - found.ids.size()),
                            grouped(faces), grouped(objects - kept.instances.size()), grouped(objects));
}

}  // namespace

std::span<const Option> visible_option_table() { return visible_options; }

int run_visible(const Settings& settings) {
  check(settings);
  const VisibleSettings& s = settings.visible;
  const std::vector<ViewSettings> places = places_of(settings);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, files_of(s));
  const Surfaces surfaces(scene, execution);
  const std::vector<View> views = views_of(settings, places, surfaces);
  if (!s.views) show_framing_warning(settings, surfaces, progress);
  const Stopwatch watch;
  FacesFound found = s.views || s.sphere ? look_often(surfaces, views, s, execution)
                                         : look_once(surfaces, views.front(), s, execution);
  const double time = watch.milliseconds();
  progress.clear();
  for (const std::string& path : s.outputs) write(path, found, scene);
  write_kept(s.kept, surfaces, found);
  if (settings.run.json) {
    Json json = {{"frontmost", FRONTMOST_VERSION}, {"model", settings.model}};
    json.update(found.json);
    json["files"] = files_of(s);
    json["timings_ms"] = {{"visible", time}};
    print(dump(json));
  } else if (!writes_standard_output(s)) {
    print(found.text);
  }
  return exit_done;
}

}  // namespace frontmost::cli
