// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/units.h"

#include <fmt/format.h>
#include <frontmost/report.h>

#include <algorithm>

namespace frontmost::cli {
namespace {

constexpr double largest_usual = 50;  // ISO 5455 has no enlargement above it

}  // namespace

std::optional<std::string> unit_hint(const DrawingSettings& s, const Surfaces& surfaces, double scale) {
  const SceneSource& source = surfaces.scene().source;
  const bool is_sheet = s.is_sheet() || s.has_frame() || s.sheet.standard_scale.value_or(false);
  if (!is_sheet || s.sheet.scale || s.sheet.millimetres_per_unit || source.metres_per_unit) return std::nullopt;
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

}  // namespace frontmost::cli
