// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/units.h"

#include <fmt/format.h>
#include <frontmost/report.h>

#include <algorithm>

#include "cli/lines/paper.h"

namespace frontmost::cli {
namespace {

struct NamedUnit {
  const char* name;
  double millimetres;
};
/// As DrawingSettings::Unit counts them.
constexpr NamedUnit units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}};
constexpr double largest_usual = 50;  // ISO 5455 has no enlargement above it

}  // namespace

double unit_of(const DrawingSettings& settings, const SceneSource& source) {
  if (settings.unit) return units[int(*settings.unit)].millimetres;
  return 1000 * source.metres_per_unit.value_or(0.001);
}

std::optional<std::string> unit_hint(const DrawingSettings& s, const Surfaces& surfaces, double scale) {
  const SceneSource& source = surfaces.scene().source;
  const bool is_sheet = s.is_sheet() || s.has_frame() || s.scale_rule == ScaleRule::standard;
  if (!is_sheet || s.unit || s.scale_rule == ScaleRule::given || source.metres_per_unit) return std::nullopt;
  if (!source.format || !(scale > largest_usual)) return std::nullopt;
  const std::vector<double> likely = likely_units(surfaces.bounds());
  std::string named;
  for (const NamedUnit& unit : units) {
    if (unit.millimetres == 1 || std::count(likely.begin(), likely.end(), unit.millimetres / 1000) == 0) continue;
    const double other = standard_scale(scale / unit.millimetres);
    named += fmt::format("{}--unit {} ({})", named.empty() ? "" : " or ", unit.name, scale_text(other));
  }
  if (named.empty()) return std::nullopt;
  return fmt::format("the scale is {}: the file says no unit, and millimetres were taken; {} would make sense",
                     scale_text(scale), named);
}

}  // namespace frontmost::cli
