// SPDX-License-Identifier: Apache-2.0
// Limits of the work for an order, and how often the work polls for cancellation.
//
// Cycles are cut until none is left. Thousands of triangles that pass through each other need millions of pieces, so
// the number of cuts is limited, and the error names the limit. The number of steps is limited as well, because a stack
// of n polygons takes n * n steps. A cancelled run ends within a millisecond. Loops count their steps in a Poll,
// because asking the caller at every step would cost more than many of the steps.
#pragma once

#include <string>
#include <utility>

#include "base/work_limit.h"

namespace frontmost::painter_detail {

[[noreturn]] inline void refuse_more_polygons_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "painter", "more than " + std::to_string(most) + " polygons and pieces");
}

/// Counts the steps of a function that gets `polygons` triangles or pieces, summed over all its threads.
class PaintEffort {
 public:
  PaintEffort(const Execution& execution, std::size_t polygons)
      : execution_(execution),
        polygons_(polygons),
        limit_(execution, kMostSteps + kStepsOfPolygon * polygons, "painter") {}

  [[nodiscard]] const Execution& execution() const { return execution_; }
  void add(std::size_t steps) {
    limit_.add(steps, [&] {
      return "too many of " + std::to_string(polygons_) + " triangles and pieces overlap in one place of the picture";
    });
  }

 private:
  // A figure of a model takes up to 500 steps for each polygon.
  static constexpr std::uint64_t kMostSteps = std::uint64_t(1) << 28, kStepsOfPolygon = 1 << 13;
  Execution execution_;
  std::size_t polygons_;
  WorkLimit limit_;
};

/// Counts steps of ten to a hundred nanoseconds each, so that a cancelled run ends within a millisecond. Belongs to one
/// thread; up to 4,095 of its last steps do not count.
class Poll {
 public:
  explicit Poll(PaintEffort& effort) : effort_(effort) {}

  [[nodiscard]] const Execution& execution() const { return effort_.execution(); }
  /// \throws Error cancelled, limit_exceeded.
  void count(std::size_t steps = 1) {
    steps_ += steps;
    if (steps_ < kEvery) return;
    effort_.add(std::exchange(steps_, 0));
  }

 private:
  static constexpr std::size_t kEvery = 4096;
  PaintEffort& effort_;
  std::size_t steps_ = 0;
};

}  // namespace frontmost::painter_detail
