// SPDX-License-Identifier: Apache-2.0
// Loops that may be long ask now and then whether they are still wanted.
#pragma once

#include "base/parallel.h"

namespace frontmost::painter_detail {

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
