// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, termination and --timeout: the program ends at once, except while a file is being written, when the library
// is asked to stop and takes the unfinished file away.
#pragma once

#include <frontmost/base.h>

#include <optional>

namespace frontmost::cli {

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

/// Whether a line of progress stands on the terminal that must go first.
void clear_line_when_interrupted(bool shown);

[[nodiscard]] bool is_interrupted();
/// \throws Error cancelled
void stop_if_interrupted();
/// Says why on standard error where there is something to say. \returns the exit status.
int report_interruption();

}  // namespace frontmost::cli
