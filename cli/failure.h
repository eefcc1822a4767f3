// SPDX-License-Identifier: Apache-2.0
// Exit statuses, and the one error type that the library does not have: bad usage.
#pragma once

#include <stdexcept>
#include <string>

namespace frontmost::cli {

enum ExitStatus : int { exit_done = 0, exit_could_not = 1, exit_usage = 2, exit_differs = 3, exit_interrupted = 130 };

/// A command line or batch file that cannot be meant. what() names the flag or place first.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace frontmost::cli
