// SPDX-License-Identifier: Apache-2.0
// Work that is counted, so that what would take hours ends with an error: after the same work on every machine, and
// never by a clock.
#pragma once

#include <atomic>
#include <string>

#include "base/parallel.h"

namespace frontmost {

/// The work of all threads that share it.
class WorkLimit {
 public:
  /// Borrows what watches the execution. The owner says what a step is; `place` is that of the error.
  WorkLimit(const Execution& execution, std::uint64_t most, const char* place)
      : execution_(execution), most_(most), place_(place) {}

  /// Counts steps, and asks whether to stop. To be called once in some ten thousand steps. `too_much()` makes the
  /// reason of the error, in which nothing may depend on which thread comes first. \throws Error limit_exceeded,
  /// cancelled.
  template <class Text>
  void add(std::uint64_t steps, const Text& too_much) {
    check_cancelled(execution_);
    if ((done_ += steps) > most_) throw Error(ErrorCode::limit_exceeded, place_, too_much());
  }

 private:
  Execution execution_;
  std::uint64_t most_;
  const char* place_;
  std::atomic<std::uint64_t> done_{0};
};

}  // namespace frontmost
