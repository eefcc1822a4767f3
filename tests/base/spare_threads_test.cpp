// SPDX-License-Identifier: Apache-2.0
// Threads that the system refuses, by a system that refuses them when it is told to.
#include "base/spare_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <system_error>

namespace frontmost {
namespace {

/// Gives `most` threads that live at once, and then `Refusal`.
template <class Refusal>
int count_with(int wanted, int most, const Refusal& refusal) {
  std::atomic<int> begun{0};
  const int count = count_spare_threads(wanted, [&](std::function<void()> body) {
    if (begun == most) throw refusal;
    ++begun;
    return std::thread(std::move(body));
  });
  EXPECT_EQ(begun, std::min(wanted, most)) << "it ends at the first that is refused";
  return count;
}

TEST(SpareThreads, AreCountedUntilOneIsRefused) {
  const std::system_error refusal(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_EQ(count_with(8, 100, refusal), 8);
  EXPECT_EQ(count_with(8, 8, refusal), 8);
  EXPECT_EQ(count_with(8, 3, refusal), 3);
  EXPECT_EQ(count_with(8, 0, refusal), 0);
  EXPECT_EQ(count_with(8, 5, std::bad_alloc()), 5) << "memory for a thread is refused likewise";
  EXPECT_EQ(count_with(0, 5, refusal), 0);
}

}  // namespace
}  // namespace frontmost
