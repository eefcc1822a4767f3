// SPDX-License-Identifier: Apache-2.0
// From what was said about a drawing to the library's options, and from its complaints to the flags; and what the
// model's numbers mean on paper.
//
// The library names a field of SheetOptions in what it complains of; a flag has that field's name with other dashes, so
// a complaint about one is an error of usage that names the flag.
#pragma once

#include <frontmost/scene.h>

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

/// What to say where --unit overrules the file. And where a sheet's scale, which nobody asked for, is larger than any
/// that drawings have (50:1, ISO 5455), because the file says no unit and millimetres were taken: the units that are
/// likely for a model of this size. None where all is well, or nothing else is likely.
[[nodiscard]] std::optional<std::string> unit_hint(const DrawingSettings& settings, const Surfaces& surfaces,
                                                   double scale);

/// Finds options that exclude or need one another, before any model is read. \throws UsageError naming them
void check_drawing_settings(const Settings& settings);

/// The options of a sheet of a model of that name.
[[nodiscard]] SheetOptions sheet_options(const Settings& settings, const std::string& model);

/// Draws what the settings say. \throws UsageError where a value has no room on the page or misses the model, naming
/// its flag; Error otherwise.
[[nodiscard]] Sheet draw_from_settings(const Settings& settings, const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::cli
