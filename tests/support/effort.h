// SPDX-License-Identifier: Apache-2.0
// How much random tests try, and how much work a call takes, measured by counting, which other load does not disturb.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "frontmost/base.h"

extern "C" {
[[gnu::weak]] void __asan_init();
[[gnu::weak]] void __tsan_init();
}

namespace frontmost::test {

/// Whether a sanitizer's runtime is linked; the tests themselves may be compiled without it. An emulator counts as one,
/// as it is equally slow.
#if defined(FRONTMOST_EMULATED)
inline const bool under_sanitizer = true;
#else
inline const bool under_sanitizer = &__asan_init || &__tsan_init;
#endif

/// Whether tests try little: under a sanitizer, which is ten to thirty times slower and looks for other faults than
/// wrong results; and where FRONTMOST_TRY_LITTLE is set, as ./dev room does for a quick answer.
inline const bool tries_little = under_sanitizer || std::getenv("FRONTMOST_TRY_LITTLE");

/// Number of seeds to try: all or, where tests try little, an eighth.
inline std::uint64_t seeds(std::uint64_t count) { return tries_little ? (count + 7) / 8 : count; }

/// Cancels at question number `last` and at all later ones; without `last`, never.
class CountingWatch {
 public:
  static constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

  explicit CountingWatch(std::size_t last = never) : last_(last) {
    watch_.cancelled = [this] { return ++asked_ >= last_; };
  }
  CountingWatch(const CountingWatch&) = delete;
  CountingWatch& operator=(const CountingWatch&) = delete;

  /// By default one thread, so that the number of questions is always the same.
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
