// SPDX-License-Identifier: Apache-2.0
// Names as texts: they come from files, and may be any bytes.
#pragma once

#include <string>
#include <string_view>

namespace frontmost {

/// `text` as UTF-8, whatever bytes it holds: one that is no part of a character is written as four, such as \xE9. For
/// JSON, which has its own way to write control characters. O(size).
[[nodiscard]] std::string utf8_text(std::string_view text);
/// The same for terminals and pages, with control characters written likewise: a line feed is \x0A.
[[nodiscard]] std::string printable_text(std::string_view text);

}  // namespace frontmost
