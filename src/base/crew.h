// SPDX-License-Identifier: Apache-2.0
// Threads that stay for the next loop, where there is no TBB: to make some for every loop takes as long as many a loop,
// and WebAssembly gives back those that have ended only when the page comes to rest.
//
//   run(2, work)     work here   ------------------------------+ wait until nobody is inside
//   a thread         sleeps  -- work ----------------+ sleeps
//   a thread         in another loop's work -------------- sleeps
//
// Loops within loops, and loops of several callers, share them: whoever calls does its own work, and a thread that is
// free comes to help. Nothing is waited for but work that has begun.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontmost {

/// Is never destroyed, as threads wait in it until the process ends. A process that forked has none of the threads: it
/// does all of its work itself.
class Crew {
 public:
  /// Does `work` here and on up to `helpers` other threads at the same time. \returns when all have come back. `work`
  /// must not throw, and must return at once where nothing is left to do.
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
    int wanted;      ///< more threads
    int inside = 0;  ///< threads
  };

  /// So that there are as many threads as the largest loop so far wanted.
  void hire(int helpers) {
    try {
      for (; size_ < std::min(helpers, most_); ++size_) std::thread([this] { serve(); }).detach();
    } catch (const std::exception&) {
      // The system gives no more threads: those that there are do the same work.
      most_ = size_;
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
  int size_ = 0, most_ = 1024;
};

}  // namespace frontmost
