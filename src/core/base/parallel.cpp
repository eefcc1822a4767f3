// SPDX-License-Identifier: Apache-2.0
// Loops over chunks on threads. With TBB, its threads are used if it can be trusted, else threads made for one loop;
// without TBB the threads of a crew, which stay.
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
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#if defined(FRONTMOST_THREADS_std)
#include "base/crew.h"
#elif defined(FRONTMOST_THREADS_tbb)
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/spare_threads.h"
#endif

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
      // Relaxed: only the number matters; the caller sees the writes of bodies at the end of the loop.
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

#if defined(FRONTMOST_THREADS_tbb)
/// Drains the queue on threads made for this loop alone.
void drain_on_own(int threads, ChunkQueue& queue) {
  std::vector<std::thread> helpers;
  helpers.reserve(std::size_t(threads));
  try {
    for (int i = 1; i < threads; ++i) helpers.emplace_back([&] { queue.drain(); });
  } catch (const std::exception&) {
    // The system gives no more threads, or no memory for them: the existing ones do the same work.
  }
  queue.drain();
  for (std::thread& helper : helpers) helper.join();
}

/// An arena for so many threads: more threads than cores need both an arena of their own and a higher global limit.
struct Helpers {
  explicit Helpers(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads)), arena(threads) {}

  tbb::global_control limit;
  tbb::task_arena arena;
};

/// Makes TBB start its threads now, with work that waits until all have come. TBB may start fewer at first; it then
/// starts the rest when it wants to.
void gather(int threads) {
  constexpr std::chrono::milliseconds patience(50);
  const auto until = std::chrono::steady_clock::now() + patience;
  std::atomic<int> arrived{0};
  Helpers helpers(threads);
  helpers.arena.execute([&] {
    tbb::parallel_for(
        0, threads, 1,
        [&](int) {
          for (++arrived; arrived < threads && std::chrono::steady_clock::now() < until;) std::this_thread::yield();
        },
        tbb::simple_partitioner());
  });
}

/// Whether TBB can be trusted with so many threads: a refused thread makes it end the process. So as many are tried
/// beforehand, and as many again, because tried threads may count a little longer than they live.
bool tbb_may_use(int threads) {
  static std::mutex mutex;
  static std::atomic<int> made{1};
  static bool is_scarce = false;
  if (threads <= made) return true;
  const std::lock_guard lock(mutex);
  if (threads <= made) return true;
  const int tried = 2 * (threads - made);
  if (!is_scarce)
    is_scarce = count_spare_threads(tried, [](auto body) { return std::thread(std::move(body)); }) < tried;
  if (is_scarce) return false;
  gather(threads);
  made = threads;
  return true;
}

void drain_here(int threads, ChunkQueue& queue) {
  tbb::parallel_for(
      0, threads, 1, [&](int) { queue.drain(); }, tbb::simple_partitioner());
}

void drain_on(int threads, ChunkQueue& queue) {
  if (!tbb_may_use(threads)) return drain_on_own(threads, queue);
  // In the caller's own arena, helpers look for the next loop for some 50 us before they sleep: waking one takes 40 us,
  // as long as many a loop. A thread that waits for the end of an inner loop must not begin chunks of the outer loop
  // meanwhile.
  if (threads <= tbb::this_task_arena::max_concurrency())
    return tbb::this_task_arena::isolate([&] { drain_here(threads, queue); });
  Helpers helpers(threads);
  helpers.arena.execute([&] { drain_here(threads, queue); });
}
#elif defined(FRONTMOST_THREADS_std)
void drain_on(int threads, ChunkQueue& queue) {
  Crew::of_process().run(threads - 1, [&] { queue.drain(); });
}
#else
void drain_on(int, ChunkQueue& queue) { queue.drain(); }
#endif

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
    drain_on(threads, queue);
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
