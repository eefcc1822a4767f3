// SPDX-License-Identifier: Apache-2.0
// Formats that are not read, and which programs make models of them that are.
#pragma once

#include <optional>
#include <string>

#include "io/models/reader.h"

namespace frontmost {

/// What to say of a file in a format that is known but not read, with the command line that converts it: by the suffix
/// of `path`. None: not one of those.
[[nodiscard]] std::optional<std::string> conversion_by_suffix(const std::string& path);
/// The same by the first bytes, for what has no suffix, such as standard input.
[[nodiscard]] std::optional<std::string> conversion_by_content(Bytes bytes);

}  // namespace frontmost
