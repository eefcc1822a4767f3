// SPDX-License-Identifier: Apache-2.0
#include "base/spare_threads.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <vector>

namespace frontmost {

int count_spare_threads(int wanted, const StartThread& start) {
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
