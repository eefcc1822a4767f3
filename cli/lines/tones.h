// SPDX-License-Identifier: Apache-2.0
// Hatching and dots of frontmost lines.
#pragma once

#include "cli/lines/lines_report.h"

namespace frontmost::cli {

/// \throws UsageError for options that others need.
void check_tones(const DrawingSettings& settings);

/// Puts what was asked for on a view whose place on the sheet is settled. \throws UsageError where its pixels are too
/// few for it.
void add_tones(DrawnView& view, const DrawingSettings& settings, const Execution& execution);

}  // namespace frontmost::cli
