// SPDX-License-Identifier: Apache-2.0
// Standard output and error: results on the one, everything about them on the other, and there the progress of long
// work on one line of a terminal.
#pragma once

#include <frontmost/base.h>

#include <chrono>
#include <glm/glm.hpp>
#include <mutex>
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

/// With a comma before every three digits: 1,234,567.
[[nodiscard]] std::string grouped(std::uint64_t number);

/// A name from a file, for a terminal: as printable_text() writes it, or "(no name)".
[[nodiscard]] std::string printable_name(std::string_view name);

/// Progress of long work. Shows nothing for the first half second, and nothing at all where standard error is not a
/// terminal.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// For Execution; valid as long as this lives. Its `cancelled` is Ctrl-C and --timeout.
  [[nodiscard]] const Watch* watch() const { return &watch_; }
  /// What goes in front of the stage, such as "view 3 of 20: ".
  void set_prefix(std::string prefix);
  /// Takes the line away, before something else is printed.
  void clear();

 private:
  void show(std::string_view stage, double fraction);

  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool shown_ = false;
  Clock::time_point next_;
  std::string prefix_;
  std::mutex mutex_;
  Watch watch_;
};

}  // namespace frontmost::cli
