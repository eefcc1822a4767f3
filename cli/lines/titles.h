// SPDX-License-Identifier: Apache-2.0
// Frames and title blocks of frontmost lines.
#pragma once

#include <frontmost/title_block.h>

#include "cli/settings.h"

namespace frontmost::cli {

/// \throws UsageError for options that exclude each other.
void check_frame(const DrawingSettings& settings);

/// Puts frame and title block on a page whose drawing is done, and gives it its title. `scale` is none in perspective;
/// `name` is the model's.
void add_frame(Page& page, const Settings& settings, std::optional<double> scale, const std::string& name);

}  // namespace frontmost::cli
