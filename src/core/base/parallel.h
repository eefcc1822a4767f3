// SPDX-License-Identifier: Apache-2.0
// Loops on threads (the only way to use threads), and the processor settings that every result depends on.
//
// Chunk boundaries depend on the range and the grain, never on the number of threads. So work split by chunk gives the
// same result for any number of threads:
//
//   indices   0        grain     2 grain   3 grain       count
//             |---------|---------|---------|-----...-----|
//             chunk 0    chunk 1   chunk 2                    taken in this order by whichever thread is free
//
// Rounding mode and flush-to-zero change the last bits of everything. Bodies of loops always run with the IEEE
// defaults; code that computes outside of a loop makes an IeeeScope first.
#pragma once

#include <cfenv>
#include <cstddef>

#include "frontmost/base.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace frontmost {

namespace detail {
using ChunkFunction = void (*)(void* context, std::size_t begin, std::size_t end);
void run_chunks(const Execution& execution, std::size_t count, std::size_t grain, ChunkFunction function,
                void* context);
}  // namespace detail

/// Calls `body(begin, end)` for consecutive chunks of `grain` indices that cover [0, count), in any order, on
/// execution.threads threads. Rethrows the first exception of a body. Polls Watch::cancelled between chunks. Every body
/// runs with round-to-nearest and without flush-to-zero, whatever the caller's setting.
template <class Body>
void parallel_for(const Execution& execution, std::size_t count, std::size_t grain, Body&& body) {
  detail::run_chunks(
      execution, count, grain,
      [](void* context, std::size_t begin, std::size_t end) {
        (*static_cast<std::remove_reference_t<Body>*>(context))(begin, end);
      },
      &body);
}

/// The number of threads that parallel_for would use. \throws Error bad_argument outside 0 to 1024.
[[nodiscard]] int thread_count(const Execution& execution);

/// \throws Error cancelled if Watch::cancelled returns true.
void check_cancelled(const Execution& execution);
/// Reports to the watch, if there is one.
void report_progress(const Execution& execution, std::string_view stage, double fraction);

class IeeeScope {
 public:
#if defined(__SSE2__)
  IeeeScope() : saved_(_mm_getcsr()) { _mm_setcsr(kDefault); }
  ~IeeeScope() { _mm_setcsr(saved_); }

 private:
  static constexpr unsigned kDefault = 0x1F80;  // all exceptions masked, round to nearest, no FTZ, no DAZ
  unsigned saved_;
#else
  IeeeScope() : saved_(std::fegetround()) { std::fesetround(FE_TONEAREST); }
  ~IeeeScope() { std::fesetround(saved_); }

 private:
  int saved_;
#endif

 public:
  IeeeScope(const IeeeScope&) = delete;
  IeeeScope& operator=(const IeeeScope&) = delete;
};

}  // namespace frontmost
