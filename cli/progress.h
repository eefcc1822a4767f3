// SPDX-License-Identifier: Apache-2.0
// Progress of long work, on one line of a terminal.
#pragma once

#include <frontmost/base.h>

#include <chrono>
#include <mutex>
#include <string>

namespace frontmost::cli {

/// Shows nothing for the first half second, and nothing at all where standard error is not a terminal.
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
