// SPDX-License-Identifier: Apache-2.0
// Ends work that would take hours with an error: after the same amount on every machine, never by a clock.
#pragma once

#include <atomic>
#include <string>

#include "base/parallel.h"

namespace frontmost {

/// A limit of the work of all threads that share it.
class WorkLimit {
 public:
  /// Borrows the watch of the execution. The owner defines a step; `place` is the place of the error.
  WorkLimit(const Execution& execution, std::uint64_t most, const char* place)
      : execution_(execution), most_(most), place_(place) {}

  /// Counts steps, and checks whether to stop. Call it once in some ten thousand steps. `too_much()` makes the reason
  /// of the error, which must not depend on the order of threads. \throws Error limit_exceeded, cancelled.
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
