// SPDX-License-Identifier: Apache-2.0
// What the model's numbers mean on paper.
#pragma once

#include <frontmost/surfaces.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

/// Millimetres to the model's unit.
[[nodiscard]] double unit_of(const DrawingSettings& settings, const SceneSource& source);

/// What to say where a sheet's scale, which nobody asked for, is larger than any that drawings have (50:1, ISO 5455),
/// because the file says no unit and millimetres were taken: the units that are likely for a model of this size.
/// None where all is well, or nothing else is likely.
[[nodiscard]] std::optional<std::string> unit_hint(const DrawingSettings& settings, const Surfaces& surfaces,
                                                   double scale);

}  // namespace frontmost::cli
