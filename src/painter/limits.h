// SPDX-License-Identifier: Apache-2.0
// How much work an order may be, and how often it asks whether it is still wanted.
//
// Cycles are cut until none is left, and where thousands of triangles pass through each other that takes millions of
// pieces: so their number is limited, and the error says what the limit was. A caller that cancels a run waits for a
// millisecond at most: loops count their steps in a Poll, because asking the caller at every step would cost more than
// many of these steps do.
#pragma once

#include <string>

#include "base/parallel.h"
#include "frontmost/base.h"

namespace frontmost::painter_detail {

[[noreturn]] inline void refuse_more_polygons_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "painter: more than " + std::to_string(most) + " polygons and pieces");
}

/// Counts steps of about a hundred nanoseconds each, so that a cancelled run ends within a millisecond.
class Poll {
 public:
  explicit Poll(const Execution& execution) : execution_(execution) {}

  [[nodiscard]] const Execution& execution() const { return execution_; }
  /// \throws Error cancelled.
  void count(std::size_t steps = 1) {
    steps_ += steps;
    if (steps_ < kEvery) return;
    steps_ = 0;
    check_cancelled(execution_);
  }

 private:
  static constexpr std::size_t kEvery = 4096;
  const Execution& execution_;
  std::size_t steps_ = 0;
};

}  // namespace frontmost::painter_detail
