// SPDX-License-Identifier: Apache-2.0
// How a run ends before it is done: by bad usage, by an error about some file, or by Ctrl-C, termination and --timeout.
// Those end the program at once, except while a file is being written, when the library is asked to stop and takes the
// unfinished file away.
#pragma once

#include <frontmost/base.h>

#include <optional>
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

/// Whether an error names a file or an option. Others name a value or a method of the library: "near: must be greater
/// than 0".
[[nodiscard]] bool names_culprit(const Error& error);

/// The error as one of the file that it is about: the pose file, or the model, where it names none.
[[nodiscard]] Error with_culprit(const Error& error, const Settings& settings);

/// Catches SIGINT, SIGTERM, SIGHUP, and starts the clock; a file that grows too large, and a reader that goes away, are
/// failed writes from now on. Call once.
void catch_interruptions(std::optional<double> timeout_seconds);

/// While one of these lives, an interruption waits for the library to clean up.
class WritingFiles {
 public:
  WritingFiles();
  /// Does not throw; an interruption that came meanwhile is found by stop_if_interrupted().
  ~WritingFiles();
  WritingFiles(const WritingFiles&) = delete;
  WritingFiles& operator=(const WritingFiles&) = delete;
};

/// While one of these lives, other ranks are waited for, and --timeout says so.
class WaitingForRanks {
 public:
  WaitingForRanks();
  ~WaitingForRanks();
  WaitingForRanks(const WaitingForRanks&) = delete;
  WaitingForRanks& operator=(const WaitingForRanks&) = delete;
};

/// Whether a line of progress stands on the terminal that must go first.
void clear_line_when_interrupted(bool shown);

[[nodiscard]] bool is_interrupted();
/// \throws Error cancelled
void stop_if_interrupted();
/// Says why on standard error where there is something to say. \returns the exit status.
int report_interruption();

}  // namespace frontmost::cli
