// SPDX-License-Identifier: Apache-2.0
// Threads that stay for the next loop, for builds without TBB. Making threads for every loop takes as long as many a
// loop, and WebAssembly frees ended threads only when the page comes to rest.
//
//   run(2, work)     work here   ------------------------------+ wait until nobody is inside
//   a thread         sleeps  -- work ----------------+ sleeps
//   a thread         in another loop's work -------------- sleeps
//
// Nested loops and loops of several callers share the threads: every caller does its own work, and free threads come to
// help. A loop waits only for work that has begun.
#pragma once

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontmost {

/// Never destroyed, as threads wait in it until the process ends.
class Crew {
 public:
  /// The crew of all loops of the process. A forked process gets its own, because a fork takes no threads along.
  static Crew& of_process() {
    static std::atomic<Crew*> crew = new Crew;
#if !defined(__EMSCRIPTEN__)
    [[maybe_unused]] static const int is_told = pthread_atfork(nullptr, nullptr, [] { crew = new Crew; });
#endif
    return *crew;
  }

  /// Does `work` here and on up to `helpers` other threads at the same time. \returns once all have come back. `work`
  /// must not throw, and must return at once if nothing is left to do.
  void run(int helpers, const std::function<void()>& work) {
    Job job{&work, helpers};
    {
      const std::lock_guard lock(mutex_);
      hire(helpers);
      jobs_.push_back(&job);
    }
    for (int i = 0; i < helpers; ++i) called_.notify_one();
    work();
    std::unique_lock lock(mutex_);
    std::erase(jobs_, &job);
    left_.wait(lock, [&] { return job.inside == 0; });
  }

 private:
  struct Job {
    const std::function<void()>* work;
    int wanted;      ///< threads that may still join
    int inside = 0;  ///< threads at work
  };

  /// Makes as many threads as the largest loop so far wanted.
  void hire(int helpers) {
    if (pause_ > 0) return void(--pause_);
    try {
      for (; size_ < helpers; ++size_) std::thread([this] { serve(); }).detach();
    } catch (const std::exception&) {
      // The system gives no more threads now: the existing ones do the same work, and the system is asked again later.
      constexpr int loops = 1000;
      pause_ = loops;
    }
  }

  [[nodiscard]] Job* open_job() const {
    const auto open = std::find_if(jobs_.begin(), jobs_.end(), [](const Job* job) { return job->wanted > 0; });
    return open == jobs_.end() ? nullptr : *open;
  }

  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      called_.wait(lock, [&] { return open_job() != nullptr; });
      Job& job = *open_job();
      --job.wanted, ++job.inside;
      lock.unlock();
      (*job.work)();
      lock.lock();
      if (--job.inside == 0) left_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable called_, left_;
  std::vector<Job*> jobs_;
  int size_ = 0;
  int pause_ = 0;  ///< loops until more threads are asked for, after a refusal
};

}  // namespace frontmost
