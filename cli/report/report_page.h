// SPDX-License-Identifier: Apache-2.0
// The report as a page: one self-contained HTML file.
#pragma once

#include "cli/report/report_run.h"

namespace frontmost::cli {

/// Returns the script that makes the page interactive, without the <script> tags around it.
[[nodiscard]] std::string_view report_script();
/// Returns the graph of hiding as an SVG element, for the pairs with the most hidden samples, or an empty text if
/// nothing is hidden. Hiding objects are above hidden ones.
[[nodiscard]] std::string report_graph(const ReportRun& run);

/// Writes the whole page, or nothing. \throws Error file_unwritable.
void write_report_page(const ReportRun& run, const std::string& path, const Execution& execution);

}  // namespace frontmost::cli
