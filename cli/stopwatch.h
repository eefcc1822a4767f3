// SPDX-License-Identifier: Apache-2.0
// Times: of a whole run, and of the steps of a drawing, which draw_sheet() and draw_view() report to a watch.
#pragma once

#include <frontmost/base.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace frontmost::cli {

/// Returns the median: the middle value, or the mean of the two middle values. Precondition: not empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) * 0.5;
}

/// Measures milliseconds since its construction.
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
  /// Watches the steps of a run. `execution` and its watch must outlive this object.
  explicit StepTimes(const Execution& execution) : given_(execution) {
    if (execution.watch) watch_ = *execution.watch;
    watch_.progress = [this, show = watch_.progress](std::string_view stage, double fraction) {
      // Only the drawing thread reports these stages; several threads may report others at once.
      for (const std::string_view step : {"views", "rounds", "layout", "tones", "page"})
        if (step == stage) begin(step);
      if (show) show(stage, fraction);
    };
  }
  StepTimes(const StepTimes&) = delete;
  StepTimes& operator=(const StepTimes&) = delete;

  /// Returns the Execution for the work to be timed.
  [[nodiscard]] Execution execution() const { return {given_.threads, given_.isa, &watch_}; }
  /// Ends the current step and begins the one called `step`.
  void begin(std::string_view step) {
    milliseconds_[step_] += stopwatch_.milliseconds();
    step_ = step;
    stopwatch_ = {};
  }
  /// Returns the milliseconds of the finished steps, by name.
  [[nodiscard]] const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  const Execution& given_;
  Watch watch_;
  Stopwatch stopwatch_;
  std::string step_;
  std::map<std::string, double> milliseconds_;
};

}  // namespace frontmost::cli
