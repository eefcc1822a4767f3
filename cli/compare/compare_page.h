// SPDX-License-Identifier: Apache-2.0
// The comparison as a page: one HTML file that holds its pictures.
#pragma once

#include "cli/compare/compare_report.h"

namespace frontmost::cli {

/// \throws Error file_unwritable where the folder cannot be made or is something else.
void check_page_folder(const std::string& folder);
/// Writes index.html and the pictures that it holds. \returns their paths.
[[nodiscard]] std::vector<std::string> write_page(const Comparisons& all, const std::string& folder,
                                                  const Execution& execution);

}  // namespace frontmost::cli
