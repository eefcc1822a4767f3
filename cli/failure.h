// SPDX-License-Identifier: Apache-2.0
// Premature ends of a run: by bad usage, by an error about a file, or by Ctrl-C, termination and --timeout.
// Interruptions end the program at once, unless a file is being written. The library then is asked to stop and removes
// the unfinished file.
#pragma once

#include <frontmost/base.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

enum ExitStatus : int { exit_done = 0, exit_could_not = 1, exit_usage = 2, exit_differs = 3, exit_interrupted = 130 };

/// A command line or batch file without a valid meaning. what() begins with the flag or place.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether an error names a file or an option. Other errors name a value or a method of the library: "near: must be
/// greater than 0".
[[nodiscard]] bool names_culprit(const Error& error);

/// Returns the error. If it names no file, the pose file or the model is filled in.
[[nodiscard]] Error with_culprit(const Error& error, const Settings& settings);

/// Catches SIGINT, SIGTERM and SIGHUP, and starts the timeout. From then on, a file that grows too large and a reader
/// that goes away cause failed writes. Call once.
void catch_interruptions(std::optional<double> timeout_seconds);

/// During this object's lifetime, an interruption lets the library clean up before the program ends.
class WritingFiles {
 public:
  WritingFiles();
  /// Does not throw. stop_if_interrupted() finds interruptions that occurred meanwhile.
  ~WritingFiles();
  WritingFiles(const WritingFiles&) = delete;
  WritingFiles& operator=(const WritingFiles&) = delete;
};

/// Marks that the program waits for other ranks, which the message of --timeout then mentions.
class WaitingForRanks {
 public:
  WaitingForRanks();
  ~WaitingForRanks();
  WaitingForRanks(const WaitingForRanks&) = delete;
  WaitingForRanks& operator=(const WaitingForRanks&) = delete;
};

/// Writes a line of progress to the terminal, unless the program is interrupted. An interruption on any thread waits
/// until the line is whole, and clears it.
void show_line(std::string_view line);
/// Clears the line if there is one.
void clear_line();

[[nodiscard]] bool is_interrupted();
/// Checks for an interruption. \throws Error cancelled if there was one.
void stop_if_interrupted();
/// Prints the reason of an interruption to standard error, if there is one to tell. \returns the exit status.
int report_interruption();

}  // namespace frontmost::cli
