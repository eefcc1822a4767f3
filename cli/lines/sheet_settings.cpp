// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/sheet_settings.h"

#include <fmt/format.h>
#include <frontmost/report.h>

#include <algorithm>
#include <cmath>

#include "cli/failure.h"
#include "cli/option.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr double largest_usual = 50;  // ISO 5455 has no greater enlargement

constexpr glm::ivec2 fine_grid{3840, 2160};  // same aspect ratio as render's default picture, so that the camera is the
                                             // same

/// Calls `work` and turns the library's errors about a field of the options into usage errors about the flag of that
/// name.
template <class Work>
auto with_flags(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    std::string flag = error.place().substr(0, error.place().find(' '));
    std::replace(flag.begin(), flag.end(), '_', '-');
    const std::span<const Option> table = drawing_option_table();
    const bool is_flag = std::any_of(table.begin(), table.end(), [&](const Option& o) { return o.name == flag; });
    const bool is_of_value = error.code() == ErrorCode::bad_argument || error.code() == ErrorCode::limit_exceeded;
    if (!is_flag || !is_of_value) throw;
    throw UsageError(fmt::format("--{}{}", flag, std::string_view(error.what()).substr(flag.size())));
  }
}

void check_views(const Settings& s) {
  if (s.drawing.sheet.views.empty() && s.drawing.sheet.hidden_views) throw UsageError("--hidden-views needs --views");
  if (!s.drawing.is_sheet()) {
    if (s.drawing.projection) throw UsageError("--projection needs --views");
    if (s.drawing.sheet.dimensions != Dimensioning::none) throw UsageError("--dimensions needs --views");
    return;
  }
  const char* const sheet = s.drawing.sheet.views.empty() ? "--sections" : "--views";
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

/// Refuses options that a drawing in perspective cannot have.
void check_projection(const Settings& s) {
  if (s.view.orthographic || s.view.camera_index || s.drawing.is_sheet()) return;
  const SheetOptions& sheet = s.drawing.sheet;
  if (sheet.scale || sheet.standard_scale.value_or(false))
    throw UsageError("--scale: a perspective drawing has no scale; add --camera-orthographic or --views");
  if (sheet.centre_lines.value_or(false))
    throw UsageError("--centre-lines: a perspective drawing has none; add --camera-orthographic or --views");
}

void check_light(const DrawingSettings& s) {
  if (s.hatch_angle && !s.sheet.hatch) throw UsageError("--hatch-angle needs --hatch");
  if (s.sheet.hatch || s.sheet.stipple) return;
  if (s.light) throw UsageError("--light needs --hatch or --stipple");
  if (s.casts_shadows) throw UsageError("--cast-shadows needs --hatch or --stipple");
}

/// Whether the user chose what is in the picture, beyond the direction of view.
bool is_framed(const ViewSettings& s) {
  return s.pose || s.camera_index || s.position || s.intrinsics || s.resolution || s.zoom != 1;
}

}  // namespace

std::optional<std::string> unit_hint(const DrawingSettings& s, const Surfaces& surfaces, double scale) {
  const SceneSource& source = surfaces.scene().source;
  if (s.sheet.millimetres_per_unit) {
    const double own = 1000 * source.metres_per_unit.value_or(*s.sheet.millimetres_per_unit / 1000);
    if (std::abs(own / *s.sheet.millimetres_per_unit - 1) < 1e-9) return std::nullopt;
    return fmt::format(
        "--unit overrides the unit of the file, {:.6g} mm; to change only the unit of the dimensions, use "
        "--dimension-unit",
        own);
  }
  const bool is_sheet = s.is_sheet() || s.has_frame() || s.sheet.standard_scale.value_or(false);
  if (!is_sheet || s.sheet.scale || source.metres_per_unit) return std::nullopt;
  if (!source.format || !(scale > largest_usual)) return std::nullopt;
  const std::vector<double> likely = likely_units(surfaces.bounds());
  std::string named;
  for (const LengthUnit& unit : length_units) {
    if (unit.millimetres == 1 || std::count(likely.begin(), likely.end(), unit.millimetres / 1000) == 0) continue;
    const double other = standard_scale(scale / unit.millimetres);
    named += fmt::format("{}--unit {} ({})", named.empty() ? "" : " or ", unit.name, scale_text(other));
  }
  if (named.empty()) return std::nullopt;
  return fmt::format("the scale is {}: the file says no unit, and millimetres were taken; {} would make sense",
                     scale_text(scale), named);
}

void check_drawing_settings(const Settings& settings) {
  check_view_settings(settings.view);
  check_views(settings);
  check_projection(settings);
  check_light(settings.drawing);
  with_flags([&] { validate(sheet_options(settings, {})); });
}

SheetOptions sheet_options(const Settings& settings, const std::string& model) {
  const DrawingSettings& drawing = settings.drawing;
  SheetOptions options = drawing.sheet;
  options.projection = drawing.projection.value_or(options.projection);
  options.hatch_angle = drawing.hatch_angle.value_or(options.hatch_angle);
  options.light = drawing.light;
  options.casts_shadows = drawing.casts_shadows.value_or(true);
  options.tessellation_error = settings.view.tessellation_error;
  options.near = settings.view.near;
  options.far = settings.view.far;
  options.keeps_picture = is_framed(settings.view);
  if (!drawing.has_frame()) return options;
  TitleBlock& block = options.title_block.emplace();
  block.title = drawing.texts.title.value_or(model);
  block.number = drawing.texts.number.value_or("");
  block.author = drawing.texts.author.value_or("");
  block.date = drawing.texts.date.value_or("");
  block.owner = drawing.texts.owner.value_or("");
  block.sheet = drawing.number;
  block.sheets = drawing.count;
  return options;
}

Sheet draw_from_settings(const Settings& settings, const Surfaces& surfaces, const Execution& execution) {
  const SheetOptions options = sheet_options(settings, surfaces.scene().name);
  if (settings.drawing.is_sheet()) return with_flags([&] { return draw_sheet(surfaces, options, execution); });
  ViewSettings camera = settings.view;
  if (!camera.resolution && !camera.intrinsics) camera.resolution = fine_grid;
  camera.framed = FramedObjects::all;  // a drawing shows all objects
  const View view = resolve_view(camera, surfaces);
  return with_flags([&] { return draw_view(surfaces, view, options, execution); });
}

}  // namespace frontmost::cli
