// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/centres.h"

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

bool wants_centres(const DrawingSettings& settings) {
  const bool is_sheet = settings.is_sheet() && settings.style == DrawingSettings::Style::technical;
  return settings.centre_lines.value_or(is_sheet);
}

/// Dimensions stand at what is round as well.
bool wants_rounds(const DrawingSettings& settings) { return settings.dimensions || wants_centres(settings); }

}  // namespace

void check_centres(const Settings& settings) {
  if (settings.drawing.centre_lines.value_or(false) && !settings.view.orthographic && !settings.drawing.is_sheet())
    throw UsageError("--centre-lines: perspective has none; add --camera-orthographic, or --views");
}

void find_rounds_of(std::vector<DrawnView>& views, const Settings& settings, const Execution& execution) {
  if (!wants_rounds(settings.drawing)) return;
  for (std::size_t i = 0; i < views.size(); ++i) {
    // On sheets nothing is seen along its axis there.
    if (views[i].named == NamedView::iso) continue;
    for (std::size_t k = 0; k < i && !views[i].rounds; ++k)
      if (views[k].surfaces == views[i].surfaces) views[i].rounds = views[k].rounds;
    if (!views[i].rounds) views[i].rounds = std::make_shared<const Rounds>(find_rounds(*views[i].surfaces, execution));
  }
}

void add_centre_lines(DrawnView& view, const DrawingSettings& settings) {
  if (!view.rounds || !wants_centres(settings)) return;
  CentreLineOptions options;
  options.with_hidden = view.shows_hidden;
  options.overshoot = std::min(centre_overshoot / view.sheet.millimetres_per_pixel, 1e6);
  view.sheet.centre_lines = centre_lines_of(*view.rounds, view.drawing, view.sheet.strokes, options);
}

}  // namespace frontmost::cli
