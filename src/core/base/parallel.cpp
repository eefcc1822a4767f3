// SPDX-License-Identifier: Apache-2.0
// Loops over chunks on the threads of a crew.
//
//   caller    --- check --- chunk 0 --- chunk 2 --- chunk 5 ---+
//   helper    ------------- chunk 1 --- chunk 4 ---------------+--- the first exception is thrown again, or go on
//   helper    ------------- chunk 3 --- chunk 6 ---------------+
//
// A free thread takes the next number from one counter. This balances chunks of any length. No chunk knows which thread
// runs it, so results cannot depend on threads.
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "base/crew.h"

namespace frontmost {

void detail::run_chunks(const Execution& execution, std::size_t count, std::size_t grain, ChunkFunction function,
                        void* context) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr error;
  // Runs chunks until none is left or one has failed.
  const auto drain = [&]() noexcept {
    const IeeeScope ieee;
    for (;;) {
      // Relaxed, as only the number matters. At the end of the loop the caller sees everything that the bodies wrote.
      const std::size_t chunk = next.fetch_add(1, std::memory_order_relaxed);
      if (chunk >= chunks || failed.load(std::memory_order_relaxed)) return;
      try {
        check_cancelled(execution);
        function(context, chunk * grain, std::min(count, (chunk + 1) * grain));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        failed.store(true, std::memory_order_relaxed);
      }
    }
  };
  const int threads = static_cast<int>(std::min(std::size_t(thread_count(execution)), chunks));
  if (threads <= 1)
    drain();
  else
    Crew::of_process().run(threads - 1, [&] { drain(); });
  if (error) std::rethrow_exception(error);
}

int thread_count(const Execution& execution) {
  constexpr int kMostThreads = 1024;
  if (execution.threads < 0 || execution.threads > kMostThreads)
    throw Error(ErrorCode::bad_argument, "threads", "must be 0 (one per core) to 1024");
  if (execution.threads > 0) return execution.threads;
  static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return cores;
}

void check_cancelled(const Execution& execution) {
  if (execution.watch && execution.watch->cancelled && execution.watch->cancelled())
    throw Error(ErrorCode::cancelled, "cancelled");
}

void report_progress(const Execution& execution, std::string_view stage, double fraction) {
  if (execution.watch && execution.watch->progress) execution.watch->progress(stage, fraction);
}

}  // namespace frontmost
