// SPDX-License-Identifier: Apache-2.0
// Sections of frontmost lines.
#pragma once

#include <frontmost/section_marks.h>

#include "cli/lines/layout.h"
#include "cli/lines/lines_report.h"

namespace frontmost::cli {

/// \throws UsageError where sections were asked for and cannot be.
void check_sections(const DrawingSettings& settings);

/// Cuts `surfaces`, which the view was to show, for section number `number`: the view shows what is left.
/// \throws UsageError where the plane misses them.
void cut_view(DrawnView& view, const Surfaces& surfaces, const DrawingSettings& settings, std::size_t number,
              const View& camera, const Execution& execution);
/// Which objects have outlines that do not close, for people.
[[nodiscard]] std::vector<std::string> open_outlines(const std::vector<DrawnView>& views);

/// The cells of sections: where the view would stand that looks the same way, or in a column of their own.
void place_sections(std::vector<ViewCell>& cells, const std::vector<DrawnView>& views);
/// Lets cells keep room for cutting lines and names, and says so in the views.
void keep_section_room(std::vector<ViewCell>& cells, std::vector<DrawnView>& views);

/// Hatches the cut faces of views whose places on the sheet are settled.
void hatch_sections(std::vector<DrawnView>& views, const Settings& settings, const Execution& execution);
/// Cutting lines and names of all sections; nothing without any.
[[nodiscard]] SectionMarks marks_of(const std::vector<DrawnView>& views, const Pen& thin);

}  // namespace frontmost::cli
