// SPDX-License-Identifier: Apache-2.0
// HTML pages of one file each, with everything embedded, so that they can be mailed or archived.
#pragma once

#include <string>
#include <string_view>

namespace frontmost::cli {

/// Escapes any bytes for the text of an element or a quoted attribute. Unprintable bytes become as printable_text()
/// writes them.
[[nodiscard]] std::string html_text(std::string_view text);
/// Returns the PNG file at `path` as a value of src. Precondition: the file exists.
[[nodiscard]] std::string data_uri(const std::string& path);

/// Returns the page from the doctype to the body's start tag. `style` is added to the common style, for light and dark.
[[nodiscard]] std::string html_head(std::string_view title, std::string_view style);
/// Returns a line that names the program, and the end of the page.
[[nodiscard]] std::string html_foot();

}  // namespace frontmost::cli
