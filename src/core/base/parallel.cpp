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
namespace {

// Chunks of one loop, handed out in order to free threads.
class ChunkQueue {
 public:
  ChunkQueue(const Execution& execution, std::size_t count, std::size_t grain, detail::ChunkFunction function,
             void* context)
      : execution_(execution), count_(count), grain_(grain), function_(function), context_(context) {}

  [[nodiscard]] std::size_t chunk_count() const { return (count_ + grain_ - 1) / grain_; }

  // Runs chunks until none is left or one has failed.
  void drain() noexcept {
    const IeeeScope ieee;
    for (;;) {
      // Relaxed, as only the number matters. At the end of the loop the caller sees everything that the bodies wrote.
      const std::size_t chunk = next_.fetch_add(1, std::memory_order_relaxed);
      if (chunk >= chunk_count() || failed_.load(std::memory_order_relaxed)) return;
      try {
        check_cancelled(execution_);
        function_(context_, chunk * grain_, std::min(count_, (chunk + 1) * grain_));
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
        failed_.store(true, std::memory_order_relaxed);
      }
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const Execution& execution_;
  std::size_t count_, grain_;
  detail::ChunkFunction function_;
  void* context_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

void detail::run_chunks(const Execution& execution, std::size_t count, std::size_t grain, ChunkFunction function,
                        void* context) {
  if (count == 0) return;
  ChunkQueue queue(execution, count, std::max<std::size_t>(grain, 1), function, context);
  const int threads =
      static_cast<int>(std::min<std::size_t>(std::size_t(thread_count(execution)), queue.chunk_count()));
  if (threads <= 1) {
    queue.drain();
  } else {
    Crew::of_process().run(threads - 1, [&] { queue.drain(); });
  }
  queue.rethrow();
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
