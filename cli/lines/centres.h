// SPDX-License-Identifier: Apache-2.0
// Centre lines of frontmost lines.
#pragma once

#include "cli/lines/lines_report.h"

namespace frontmost::cli {

/// How far they reach beyond what they are drawn for, in millimetres of paper.
inline constexpr double centre_overshoot = 3;

/// \throws UsageError where they were asked for and cannot be.
void check_centres(const Settings& settings);

/// Finds what is round in the views that are to show it: once for those that draw the same surfaces.
void find_rounds_of(std::vector<DrawnView>& views, const Settings& settings, const Execution& execution);

/// Puts centre lines on a view whose place on the sheet is settled.
void add_centre_lines(DrawnView& view, const DrawingSettings& settings);

}  // namespace frontmost::cli
