// SPDX-License-Identifier: Apache-2.0
// How long things take: in all, and the steps of a drawing, as draw_sheet() and draw_view() tell them to a watch.
#pragma once

#include <frontmost/base.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace frontmost::cli {

/// The middle one of them, or the mean of the two in the middle. Precondition: not empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) * 0.5;
}

/// Milliseconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class StepTimes {
 public:
  /// `execution` must stay as long as this, with its watch.
  explicit StepTimes(const Execution& execution) : given_(execution) {
    if (execution.watch) watch_ = *execution.watch;
    watch_.progress = [this, show = watch_.progress](std::string_view stage, double fraction) {
      // The thread that draws tells these alone; other stages are told by several at a time.
      for (const std::string_view step : {"views", "rounds", "layout", "tones", "page"})
        if (step == stage) begin(step);
      if (show) show(stage, fraction);
    };
  }
  StepTimes(const StepTimes&) = delete;
  StepTimes& operator=(const StepTimes&) = delete;

  /// What is to be timed runs with this.
  [[nodiscard]] Execution execution() const { return {given_.threads, given_.isa, &watch_}; }
  /// Ends the last step, and begins one of that name.
  void begin(std::string_view step) {
    milliseconds_[step_] += stopwatch_.milliseconds();
    step_ = step;
    stopwatch_ = {};
  }
  /// By the names of the steps that have ended.
  [[nodiscard]] const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  const Execution& given_;
  Watch watch_;
  Stopwatch stopwatch_;
  std::string step_;
  std::map<std::string, double> milliseconds_;
};

}  // namespace frontmost::cli
