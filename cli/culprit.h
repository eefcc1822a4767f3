// SPDX-License-Identifier: Apache-2.0
// Which file an error is about.
#pragma once

#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

/// Whether a message begins with a file or an option, as those about files and options do. Others begin with a value or
/// a method of the library: "near: must be greater than 0".
[[nodiscard]] bool names_culprit(std::string_view message);

/// The message with the file in front that it is about: the pose file, or the model, where it names none.
[[nodiscard]] std::string with_culprit(const std::string& message, const Settings& settings);

}  // namespace frontmost::cli
