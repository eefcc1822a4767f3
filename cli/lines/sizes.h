// SPDX-License-Identifier: Apache-2.0
// Dimensions of frontmost lines.
#pragma once

#include <frontmost/dimensions.h>

#include "cli/lines/layout.h"
#include "cli/lines/lines_report.h"

namespace frontmost::cli {

/// \throws UsageError where dimensions were asked for and cannot be.
void check_dimensions(const DrawingSettings& settings);

/// Lets cells keep room for the overall sizes of their views. `cells` are of the views, in their order.
void keep_room(std::vector<ViewCell>& cells, const std::vector<DrawnView>& views, const Settings& settings);

/// Puts dimensions on a page whose views have their places: clear of its rim, or of the frame and title block that it
/// is to have, and of `marks`. \returns how many diameters there was no room for.
std::size_t add_dimensions(Page& page, const std::vector<DrawnView>& views, const std::vector<PageBox>& marks,
                           const Settings& settings);

}  // namespace frontmost::cli
