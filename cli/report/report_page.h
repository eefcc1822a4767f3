// SPDX-License-Identifier: Apache-2.0
// The report as a page: one HTML file, which needs nothing else.
#pragma once

#include "cli/report/report_run.h"

namespace frontmost::cli {

/// What makes the page answer: a script, without its element.
[[nodiscard]] std::string_view report_script();
/// Who hides whom, as an SVG element: the pairs of which most is hidden, what stands before others above them. Empty
/// where nothing hides anything.
[[nodiscard]] std::string report_graph(const ReportRun& run);

/// Writes the page, or nothing. \throws Error file_unwritable.
void write_report_page(const ReportRun& run, const std::string& path, const Execution& execution);

}  // namespace frontmost::cli
