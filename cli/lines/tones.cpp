// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/tones.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

constexpr double shortest_hatch = 0.2;  // millimetres: less is a dot of the pen

ToneOptions tone_options(const DrawingSettings& settings, const View& view) {
  ToneOptions tone;
  if (settings.light) tone.to_light = glm::dmat3(view.world_from_eye) * *settings.light;  // eye space looks down -z
  tone.casts_shadows = settings.casts_shadows.value_or(true);
  if (settings.crease_angle) tone.crease_angle = glm::radians(*settings.crease_angle);
  return tone;
}

/// Millimetres are the unit of the paper, and pixels that of the limits.
void check_spacing(const char* option, double spacing, double least) {
  if (spacing >= least) return;
  throw UsageError(fmt::format(
      "--{}: {:.6g} mm would be too many for so large a drawing; take {:.3g} or more, or a smaller --page or --scale",
      option, spacing, std::ceil(least * 100) / 100));
}

StippleOptions stipple_options(const DrawingSettings& settings, const View& view, double millimetres_per_pixel) {
  constexpr double most_dots = 2e7;  // as stipple() has it
  const double least = std::max(1.0, std::sqrt(double(view.width) * view.height / most_dots));
  check_spacing("stipple", *settings.stipple, least * millimetres_per_pixel);
  return {*settings.stipple / millimetres_per_pixel, tone_options(settings, view), !settings.plot, settings.plot};
}

HatchOptions hatch_options(const DrawingSettings& settings, const View& view, double millimetres_per_pixel) {
  HatchOptions options;
  check_spacing("hatch", *settings.hatch, millimetres_per_pixel);
  options.sets = hatch_sets(*settings.hatch / millimetres_per_pixel, glm::radians(settings.hatch_angle.value_or(45)));
  options.tone = tone_options(settings, view);
  options.shortest = std::min(shortest_hatch / millimetres_per_pixel, 1000.0);
  options.by_instance = !settings.plot;
  options.nearest_first = settings.plot;
  return options;
}

}  // namespace

void check_tones(const DrawingSettings& s) {
  if (s.hatch_angle && !s.hatch) throw UsageError("--hatch-angle needs --hatch");
  if (s.hatch || s.stipple) return;
  if (s.light) throw UsageError("--light needs --hatch or --stipple");
  if (s.casts_shadows) throw UsageError("--cast-shadows needs --hatch or --stipple");
}

void add_tones(DrawnView& view, const DrawingSettings& settings, const Execution& execution) {
  const View& camera = view.drawing.view;
  const double millimetres = view.sheet.millimetres_per_pixel;
  if (settings.hatch)
    view.sheet.hatching = hatch(*view.surfaces, camera, hatch_options(settings, camera, millimetres), execution);
  if (settings.stipple)
    view.sheet.stippling = stipple(*view.surfaces, camera, stipple_options(settings, camera, millimetres), execution);
}

}  // namespace frontmost::cli
