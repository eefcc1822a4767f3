// SPDX-License-Identifier: Apache-2.0
// What frontmost lines says about a drawing.
#pragma once

#include "cli/json.h"
#include "cli/lines/step_times.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// `page` is that of the sheet, as it is written.
[[nodiscard]] Json lines_json(const Settings& settings, const Sheet& sheet, const Page& page, const StepTimes& times);

}  // namespace frontmost::cli
