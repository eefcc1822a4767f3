// SPDX-License-Identifier: Apache-2.0
// Standard output for results, and standard error for messages. Standard error also shows the progress of long work, on
// one line of a terminal.
#pragma once

#include <frontmost/base.h>

#include <chrono>
#include <glm/glm.hpp>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace frontmost::cli {

/// Writes to standard output. \throws Error file_unwritable.
void print(std::string_view text);
/// Writes one line "frontmost: ..." to standard error, escaped as printable_text() does.
void complain(std::string_view text);

/// Returns the columns and rows of the terminal at standard output, or nothing if it is no terminal.
[[nodiscard]] std::optional<glm::ivec2> output_terminal();
[[nodiscard]] bool error_is_terminal();

/// Returns the number with a comma before every three digits: 1,234,567.
[[nodiscard]] std::string grouped(std::uint64_t number);

/// Returns a name from a file in a form for terminals: escaped as printable_text() does, or "(no name)".
[[nodiscard]] std::string printable_name(std::string_view name);

/// Progress of long work. Shows nothing in the first half second, and nothing at all if standard error is no terminal.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Returns the watch for an Execution, valid during this object's lifetime. Its `cancelled` reports Ctrl-C and
  /// --timeout.
  [[nodiscard]] const Watch* watch() const { return &watch_; }
  /// Sets the text before the stage, such as "view 3 of 20: ".
  void set_prefix(std::string prefix);
  /// Removes the line of progress. Must be called before something else is printed.
  void clear();

 private:
  void show(std::string_view stage, double fraction);

  using Clock = std::chrono::steady_clock;
  bool enabled_;
  Clock::time_point next_;
  std::string prefix_;
  std::mutex mutex_;
  Watch watch_;
};

}  // namespace frontmost::cli
