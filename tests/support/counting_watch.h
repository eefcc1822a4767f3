// SPDX-License-Identifier: Apache-2.0
// A watch that counts how often work asks whether to go on: a measure of it that no clock disturbs.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>

#include "frontmost/base.h"

namespace frontmost::test {

/// Says "cancelled" at the question of number `last` and at all that follow; without one, never.
class CountingWatch {
 public:
  static constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

  explicit CountingWatch(std::size_t last = never) : last_(last) {
    watch_.cancelled = [this] { return ++asked_ >= last_; };
  }
  CountingWatch(const CountingWatch&) = delete;
  CountingWatch& operator=(const CountingWatch&) = delete;

  /// One thread, so that the number of questions is always the same.
  [[nodiscard]] Execution execution(int threads = 1) const { return {.threads = threads, .watch = &watch_}; }
  [[nodiscard]] std::size_t asked() const { return asked_; }
  /// Counts from 0 again.
  void restart() { asked_ = 0; }

 private:
  std::atomic<std::size_t> asked_ = 0;
  std::size_t last_;
  Watch watch_;
};

}  // namespace frontmost::test
