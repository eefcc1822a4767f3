// SPDX-License-Identifier: Apache-2.0
// Texts of a file on their way out of it: as names in a scene, and as parts of messages.
#pragma once

#include <string>
#include <string_view>

namespace frontmost {

/// Bytes that a name keeps. One name stands for many objects (instances of a mesh, groups of an object) and begins many
/// warnings, so that a file of a megabyte with one name as long would take gigabytes.
inline constexpr std::size_t longest_name = 1024;

/// `text` as a name: cut at `longest_name`, not within a UTF-8 character.
[[nodiscard]] std::string name_of(std::string_view text);

/// A text of the file as it may stand in a message: short, and as printable_text() writes it.
[[nodiscard]] std::string printable(std::string_view text);

/// A word of a file for a message: in quotes, and not longer than a line.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace frontmost
