// SPDX-License-Identifier: Apache-2.0
// Pages: one HTML file each, with everything in it, so that it can be mailed or kept.
#pragma once

#include <string>
#include <string_view>

namespace frontmost::cli {

/// As the text of an element or of a quoted attribute; of any bytes, as printable_text() writes them.
[[nodiscard]] std::string html_text(std::string_view text);
/// The PNG file at a path, as the value of src. Precondition: it is there.
[[nodiscard]] std::string data_uri(const std::string& path);

/// From the doctype to the body's tag. `style` is added to what all pages look like, light and dark.
[[nodiscard]] std::string html_head(std::string_view title, std::string_view style);
/// What made the page, and the end.
[[nodiscard]] std::string html_foot();

}  // namespace frontmost::cli
