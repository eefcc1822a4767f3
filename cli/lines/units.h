// SPDX-License-Identifier: Apache-2.0
// What the model's numbers mean on paper.
#pragma once

#include <frontmost/surfaces.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

struct LengthUnit {
  const char* name;
  double millimetres;
};
/// In the order of --unit.
inline constexpr LengthUnit length_units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}};

/// What to say where a sheet's scale, which nobody asked for, is larger than any that drawings have (50:1, ISO 5455),
/// because the file says no unit and millimetres were taken: the units that are likely for a model of this size.
/// None where all is well, or nothing else is likely.
[[nodiscard]] std::optional<std::string> unit_hint(const DrawingSettings& settings, const Surfaces& surfaces,
                                                   double scale);

}  // namespace frontmost::cli
