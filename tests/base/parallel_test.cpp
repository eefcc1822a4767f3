// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <vector>

namespace frontmost {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceWithChunksThatDoNotDependOnThreads) {
  for (const int threads : {1, 2, 3, 16}) {
    std::vector<int> visits(1003, 0);
    std::atomic<int> chunks{0};
    parallel_for({.threads = threads}, visits.size(), 10, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 10, 0u);
      ++chunks;
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(chunks, 101) << threads << " threads";
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 1003) << threads << " threads";
  }
}

TEST(ParallelFor, ThrowsTheFirstErrorOfABody) {
  for (const int threads : {1, 4})
    EXPECT_THROW(parallel_for({.threads = threads}, 100, 1,
                              [](std::size_t begin, std::size_t) {
                                if (begin == 17) throw Error(ErrorCode::bad_argument, "seventeen");
                              }),
                 Error);
}

TEST(ParallelFor, StopsWhenCancelled) {
  std::atomic<int> calls{0};
  const Watch watch{.progress = {}, .cancelled = [&] { return calls > 5; }};
  try {
    parallel_for({.threads = 2, .watch = &watch}, 1000, 1, [&](std::size_t, std::size_t) { ++calls; });
    FAIL() << "went on to the end";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  EXPECT_LT(calls, 20);
}

TEST(ParallelFor, RunsBodiesWithRoundToNearestWhateverTheCallerSet) {
  for (const int threads : {1, 2}) {
    std::fesetround(FE_UPWARD);
    std::atomic<int> wrong{0};
    parallel_for({.threads = threads}, 64, 1, [&](std::size_t, std::size_t) {
      volatile float one = 1.0f, tiny = 1e-10f;
      if (one + tiny != 1.0f) ++wrong;
    });
    EXPECT_EQ(std::fegetround(), FE_UPWARD) << "the caller's mode was not given back";
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(wrong, 0);
  }
}

TEST(ParallelFor, ThrowsAgainWhatTheWatchThrows) {
  const Watch watch{.progress = {}, .cancelled = []() -> bool { throw std::runtime_error("watch"); }};
  for (const int threads : {1, 4})
    EXPECT_THROW(parallel_for({.threads = threads, .watch = &watch}, 100, 1, [](std::size_t, std::size_t) {}),
                 std::runtime_error);
}

TEST(ParallelFor, RunsInsideItself) {
  for (const int threads : {1, 3}) {
    std::atomic<int> calls{0};
    parallel_for({.threads = threads}, 7, 1, [&](std::size_t, std::size_t) {
      parallel_for({.threads = threads}, 11, 2, [&](std::size_t begin, std::size_t end) { calls += int(end - begin); });
    });
    EXPECT_EQ(calls, 77);
  }
}

TEST(ParallelFor, RejectsANumberOfThreadsOutOfRange) {
  EXPECT_THROW((void)thread_count({.threads = -1}), Error);
  EXPECT_THROW((void)thread_count({.threads = 1025}), Error);
  EXPECT_GE(thread_count({}), 1);
}

}  // namespace
}  // namespace frontmost
