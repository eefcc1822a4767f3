// SPDX-License-Identifier: Apache-2.0
// How much a random test tries, and how much work something is: told by counting, which no clock disturbs.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "frontmost/base.h"

extern "C" {
[[gnu::weak]] void __asan_init();
[[gnu::weak]] void __tsan_init();
}

namespace frontmost::test {

/// Whether a sanitizer's runtime is linked; the tests themselves may be compiled without. An emulator, which is as
/// slow, counts as one.
#if defined(FRONTMOST_EMULATED)
inline const bool under_sanitizer = true;
#else
inline const bool under_sanitizer = &__asan_init || &__tsan_init;
#endif

/// All the seeds that are asked for; an eighth under a sanitizer, which is ten to thirty times slower and looks for
/// other faults than wrong results.
inline std::uint64_t seeds(std::uint64_t count) { return under_sanitizer ? (count + 7) / 8 : count; }

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
