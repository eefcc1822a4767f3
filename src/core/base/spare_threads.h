// SPDX-License-Identifier: Apache-2.0
// The number of threads that the system would still give: limits on processes and on memory refuse some.
//
// Only TBB needs this number: a refused thread makes TBB end the process, so as many threads are tried beforehand.
// Threads that are made here for one loop need no such test: after a refusal the loop continues with fewer.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontmost {

/// Starts a thread. \throws std::system_error or std::bad_alloc if there is none.
using StartThread = std::function<std::thread(std::function<void()>)>;

/// Starts threads until `wanted` live at once or one is refused, and ends them. \returns how many there were. About 15
/// us a thread.
[[nodiscard]] inline int count_spare_threads(int wanted, const StartThread& start) {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_over = false;
  const auto wait = [&] {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return is_over; });
  };
  std::vector<std::thread> threads;
  threads.reserve(std::size_t(wanted));
  try {
    while (int(threads.size()) < wanted) threads.push_back(start(wait));
  } catch (const std::exception&) {
    // A refusal is expected: the threads started so far are the answer.
  }
  {
    const std::lock_guard lock(mutex);
    is_over = true;
  }
  changed.notify_all();
  for (std::thread& thread : threads) thread.join();
  return int(threads.size());
}

}  // namespace frontmost
