// SPDX-License-Identifier: Apache-2.0
// From what was said about a drawing to the library's options, and from its complaints to the flags.
#pragma once

#include "cli/settings.h"

namespace frontmost::cli {

/// Finds options that exclude or need one another, before any model is read. \throws UsageError naming them
void check_drawing_settings(const Settings& settings);

/// The options of a sheet of a model of that name.
[[nodiscard]] SheetOptions sheet_options(const Settings& settings, const std::string& model);

/// Draws what the settings say. \throws UsageError where a value has no room on the page or misses the model, naming
/// its flag; Error otherwise.
[[nodiscard]] Sheet draw_from_settings(const Settings& settings, const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::cli
