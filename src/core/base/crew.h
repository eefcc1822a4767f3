// SPDX-License-Identifier: Apache-2.0
// Threads that are kept from loop to loop. Making threads for a loop takes as long as many loops do, and WebAssembly
// frees ended threads only when the page is idle.
//
//   run(2, work)     work here   ------------------------------+ wait until nobody is inside
//   a thread         looks out -- work ----------------+ looks out ... sleeps
//   a thread         in another loop's work -------------- looks out
//
//   Errand(work)     goes on ------------ wait(): helps in loops until the work is done
//   a thread         looks out -- work ---------------------+ looks out ... sleeps
//
// Nested loops and loops of several callers share the threads: every caller does its own work, and free threads come to
// help. A loop waits only for work that has begun. A free thread looks out for the next loop for a while before it
// sleeps, because waking a thread takes about as long as many loops do.
#pragma once

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace frontmost {

/// A Crew is never destroyed, because its threads wait in it until the process ends.
class Crew {
 public:
  /// Starts a thread that nobody waits for. \throws std::exception if the system gives none.
  using StartThread = std::function<void(std::function<void()> body)>;

  explicit Crew(StartThread start = [](std::function<void()> body) { std::thread(std::move(body)).detach(); })
      : start_(std::move(start)) {}

  /// The crew of all loops of the process. A forked process gets its own, because a fork takes no threads along.
  static Crew& of_process() {
    static std::atomic<Crew*> crew = new Crew;
#if !defined(__EMSCRIPTEN__)
    [[maybe_unused]] static const int is_told = pthread_atfork(nullptr, nullptr, [] { crew = new Crew; });
#endif
    return *crew;
  }

  struct Job {
    const std::function<void()>* work;
    int wanted;                   ///< threads that may still join
    std::atomic<int> inside = 0;  ///< threads at work
    bool is_errand = false;
  };

  /// Does `work` here and on up to `helpers` other threads at the same time. \returns once all have come back. `work`
  /// must not throw, and must return at once if nothing is left to do.
  void run(int helpers, const std::function<void()>& work) {
    Job job{&work, helpers};
    offer(job);
    work();
    withdraw(job);
    if (spin_until([&] { return job.inside == 0; })) return;
    std::unique_lock lock(mutex_);
    left_.wait(lock, [&] { return job.inside == 0; });
  }

  /// Work for one thread while its maker does something else.
  class Errand {
   public:
    /// `work` must not throw.
    Errand(Crew& crew, std::function<void()> work) : crew_(crew), work_(std::move(work)) { crew_.offer(job_); }
    ~Errand() { wait(); }
    Errand(const Errand&) = delete;
    Errand& operator=(const Errand&) = delete;

    /// Returns once the work is done. Does it here if no thread has begun it; otherwise helps in loops meanwhile.
    /// A forked process, which has no thread that does the work, returns at once.
    void wait() {
      if (getpid() != maker_) return;
      if (crew_.withdraw(job_) > 0) return work_();
      crew_.serve([&] { return job_.inside == 0; });
    }

   private:
    Crew& crew_;
    std::function<void()> work_;
    Job job_{&work_, 1, 0, true};
    pid_t maker_ = getpid();
  };

 private:
  /// Waits up to 50 us without sleeping until `is_true()` holds. \returns whether it holds.
  template <class Condition>
  static bool spin_until(const Condition& is_true) {
    constexpr std::chrono::microseconds a_while(50);
    if (is_true()) return true;
    const auto end = std::chrono::steady_clock::now() + a_while;
    do {
      std::this_thread::yield();
      if (is_true()) return true;
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }

  /// Starts threads until there are as many as the largest loop so far asked for.
  void hire(int helpers) {
    if (size_ >= helpers) return;
    if (pause_ > 0) return void(--pause_);
    try {
      for (; size_ < helpers; ++size_) start_([this] { serve([] { return false; }); });
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

  /// Lets threads join the job, and wakes those that sleep.
  void offer(Job& job) {
    int asleep = 0;
    {
      const std::lock_guard lock(mutex_);
      hire(job.wanted);
      jobs_.push_back(&job);
      places_ += job.wanted;
      asleep = std::min(job.wanted, asleep_);
    }
    for (int i = 0; i < asleep; ++i) called_.notify_one();
  }

  /// Lets no more threads join the job. \returns how many might still have joined.
  int withdraw(Job& job) {
    const std::lock_guard lock(mutex_);
    std::erase(jobs_, &job);
    places_ -= job.wanted;
    return std::exchange(job.wanted, 0);
  }

  /// Works in all jobs that come until `is_over()` holds, which the end of a job must make true.
  template <class Condition>
  void serve(const Condition& is_over) {
    for (;;) {
      spin_until([&] { return places_ > 0 || is_over(); });
      std::unique_lock lock(mutex_);
      ++asleep_;
      called_.wait(lock, [&] { return is_over() || open_job() != nullptr; });
      --asleep_;
      if (is_over()) return;
      Job& job = *open_job();
      --job.wanted, --places_, ++job.inside;
      lock.unlock();
      (*job.work)();
      const bool is_errand = job.is_errand;
      if (--job.inside > 0) continue;
      lock.lock();  // so that the notification does not fall between the caller's test and its sleep
      left_.notify_all();
      if (is_errand) called_.notify_all();  // its maker may sleep
    }
  }

  StartThread start_;
  std::mutex mutex_;
  std::condition_variable called_, left_;
  std::vector<Job*> jobs_;
  std::atomic<int> places_{0};  ///< helpers that all jobs still want
  int asleep_ = 0;
  int size_ = 0;
  int pause_ = 0;  ///< number of loops before the system is asked for threads again, after a refusal
};

}  // namespace frontmost
