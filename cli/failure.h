// SPDX-License-Identifier: Apache-2.0
// Exit statuses; bad usage, which is the one error type that the library does not have; and which file an error is
// about.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

enum ExitStatus : int { exit_done = 0, exit_could_not = 1, exit_usage = 2, exit_differs = 3, exit_interrupted = 130 };

/// A command line or batch file that cannot be meant. what() names the flag or place first.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a message begins with a file or an option, as those about files and options do. Others begin with a value or
/// a method of the library: "near: must be greater than 0".
[[nodiscard]] bool names_culprit(std::string_view message);

/// The message with the file in front that it is about: the pose file, or the model, where it names none.
[[nodiscard]] std::string with_culprit(const std::string& message, const Settings& settings);

}  // namespace frontmost::cli
