// SPDX-License-Identifier: Apache-2.0
// Standard output and error: results on the one, everything about them on the other.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace frontmost::cli {

/// Writes to standard output. \throws Error file_unwritable when that fails.
void print(std::string_view text);
/// One line on standard error, "frontmost: ...", as printable_text() writes it.
void complain(std::string_view text);

/// Columns and rows of the terminal that standard output is; none when it is not a terminal.
[[nodiscard]] std::optional<glm::ivec2> output_terminal();
[[nodiscard]] bool error_is_terminal();

/// A name from a file, for a terminal: as printable_text() writes it, or "(no name)".
[[nodiscard]] std::string printable_name(std::string_view name);

}  // namespace frontmost::cli
