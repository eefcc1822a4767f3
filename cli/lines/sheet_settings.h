// SPDX-License-Identifier: Apache-2.0
// Converts a drawing's settings to the library's options, and the library's errors to errors about flags. Also
// interprets the model's numbers as lengths on paper.
//
// The library's errors name a field of SheetOptions. The flag has that field's name, with dashes, so the error becomes
// a usage error that names the flag.
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
/// Units in the order of --unit.
inline constexpr LengthUnit length_units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}};

/// Returns a hint about the model's unit, if --unit overrules the file. Also returns a hint, with likely units for the
/// model's size, if a sheet's automatic scale exceeds any usual one (50:1, ISO 5455) because the file states no unit
/// and millimetres were assumed. Returns nothing if nothing is odd or no other unit is likely.
[[nodiscard]] std::optional<std::string> unit_hint(const DrawingSettings& settings, const Surfaces& surfaces,
                                                   double scale);

/// Finds options that exclude or need one another, before a model is read. \throws UsageError naming the options.
void check_drawing_settings(const Settings& settings);

/// Returns the options of a sheet for the model of that name.
[[nodiscard]] SheetOptions sheet_options(const Settings& settings, const std::string& model);

/// Draws the sheet. \throws UsageError naming a flag if its value does not fit on the page or misses the model; other
/// errors as Error.
[[nodiscard]] Sheet draw_from_settings(const Settings& settings, const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::cli
