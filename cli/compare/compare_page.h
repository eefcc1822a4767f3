// SPDX-License-Identifier: Apache-2.0
// The comparison as a page: one HTML file that holds its pictures.
#pragma once

#include "cli/compare/compare_report.h"

namespace frontmost::cli {

/// The names of the page's files: pictures and maps of differences, and index.html.
[[nodiscard]] std::vector<std::string> page_names();
/// Writes them all into the folder, or none. \throws Error file_unwritable.
void write_page(const Comparisons& all, const std::string& folder, const Execution& execution);

}  // namespace frontmost::cli
