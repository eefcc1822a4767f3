// SPDX-License-Identifier: Apache-2.0
// How much work an order may be, and how often it asks whether it is still wanted.
//
// Cycles are cut until none is left, and where thousands of triangles pass through each other that takes millions of
// pieces: so their number is limited, and the error says what the limit was. So is the number of steps, because a stack
// of n sheets takes n * n of them. A caller that cancels a run waits for a millisecond at most: loops count their steps
// in a Poll, because asking the caller at every step would cost more than many of these steps do.
#pragma once

#include <string>
#include <utility>

#include "base/work_limit.h"

namespace frontmost::painter_detail {

[[noreturn]] inline void refuse_more_polygons_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "painter", "more than " + std::to_string(most) + " polygons and pieces");
}

/// The steps of a function that takes `polygons` triangles or pieces, of all its threads together.
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
  // A figure of a model takes up to 500 for each polygon.
  static constexpr std::uint64_t kMostSteps = std::uint64_t(1) << 28, kStepsOfPolygon = 1 << 13;
  Execution execution_;
  std::size_t polygons_;
  WorkLimit limit_;
};

/// Counts steps of ten to a hundred nanoseconds each, so that a cancelled run ends within a millisecond. One thread's;
/// of its last steps up to 4,095 do not count.
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
