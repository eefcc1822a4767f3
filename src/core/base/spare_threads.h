// SPDX-License-Identifier: Apache-2.0
// How many more threads the system would give: limits on processes and on memory refuse some.
//
// Only TBB needs to know: a thread that the system refuses it ends the process, so as many are tried beforehand.
// Threads that are made here for one loop need not: who is refused some goes on with those that there are.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontmost {

/// Starts a thread. \throws std::system_error or std::bad_alloc where there is none.
using StartThread = std::function<std::thread(std::function<void()>)>;

/// Starts threads until `wanted` live at once or one is refused, and ends them. \returns how many there were.
/// About 15 us a thread.
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
    // Refused, as may well be: those that there are say how many.
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
