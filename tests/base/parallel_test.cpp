// SPDX-License-Identifier: Apache-2.0
// Loops over chunks: every index once, the same chunks for all thread counts, errors, cancelling, and the caller's
// rounding mode.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

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

TEST(ParallelFor, RunsInsideItselfOnAnyNumbersOfThreads) {
  for (const int threads : {1, 2, 3, 5})
    for (const int inner_threads : {1, 2, 4}) {
      std::atomic<int> calls{0};
      for (int round = 0; round < 20; ++round)
        parallel_for({.threads = threads}, 7, 1, [&](std::size_t, std::size_t) {
          parallel_for({.threads = inner_threads}, 11, 2,
                       [&](std::size_t begin, std::size_t end) { calls += int(end - begin); });
        });
      EXPECT_EQ(calls, 20 * 77);
    }
}

// A chunk of the outer loop must not start here: two chunks would use the same scratch memory, and chunks would nest
// without end. A sleeping thread makes the others wait, and they would then look for work.
TEST(ParallelFor, WhoWaitsForAnInnerLoopBeginsNoChunkOfTheOuterOne) {
  for (const int threads : {2, 5}) {
    std::atomic<int> nested{0}, calls{0};
    for (int round = 0; round < 10; ++round)
      parallel_for({.threads = threads}, 64, 1, [&](std::size_t, std::size_t) {
        thread_local int depth = 0;
        nested += depth++;
        parallel_for({.threads = 2}, 4, 1, [&](std::size_t, std::size_t) {
          std::this_thread::sleep_for(std::chrono::microseconds(50));
          ++calls;
        });
        --depth;
      });
    EXPECT_EQ(nested, 0);
    EXPECT_EQ(calls, 10 * 64 * 4);
  }
}

TEST(ParallelFor, RejectsANumberOfThreadsOutOfRange) {
  for (const int threads : {-1, 1025, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    int calls = 0;
    try {
      parallel_for({.threads = threads}, 10, 1, [&](std::size_t, std::size_t) { ++calls; });
      FAIL() << threads;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_STREQ(error.what(), "threads: must be 0 (one per core) to 1024");
    }
    EXPECT_EQ(calls, 0) << "nothing is begun";
  }
  EXPECT_GE(thread_count({}), 1);
  EXPECT_EQ(thread_count({.threads = 1}), 1);
  EXPECT_EQ(thread_count({.threads = 1024}), 1024);
}

TEST(ParallelFor, NothingToDoIsDone) {
  for (const int threads : {1, 3}) {
    const Watch watch{.progress = {}, .cancelled = [] { return true; }};
    EXPECT_NO_THROW(parallel_for({.threads = threads, .watch = &watch}, 0, 4,
                                 [](std::size_t, std::size_t) { ADD_FAILURE() << "there is no chunk"; }));
  }
}

TEST(ParallelFor, TheLastChunkMayBeShortAndTheGrainTooLarge) {
  for (const auto& [count, grain, chunks] :
       {std::array<std::size_t, 3>{1, 100, 1}, {100, 100, 1}, {101, 100, 2}, {7, 3, 3}, {5, 0, 5}}) {
    std::vector<std::pair<std::size_t, std::size_t>> ranges;
    parallel_for({.threads = 1}, count, grain,
                 [&](std::size_t begin, std::size_t end) { ranges.emplace_back(begin, end); });
    ASSERT_EQ(ranges.size(), chunks) << count << " by " << grain;
    EXPECT_EQ(ranges.front().first, 0u);
    EXPECT_EQ(ranges.back().second, count) << "no chunk goes beyond the end";
    for (std::size_t i = 1; i < ranges.size(); ++i) EXPECT_EQ(ranges[i].first, ranges[i - 1].second);
  }
}

TEST(ParallelFor, RunsOnNoMoreThreadsThanThereAreChunksOrWereAskedFor) {
  for (const auto& [threads, chunks] : {std::pair(3, 100), std::pair(16, 2), std::pair(1, 50)}) {
    std::mutex mutex;
    std::set<std::thread::id> ids;
    parallel_for({.threads = threads}, std::size_t(chunks), 1, [&](std::size_t, std::size_t) {
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
    EXPECT_LE(ids.size(), std::size_t(std::min(threads, chunks)));
    if (threads == 1) {
      EXPECT_EQ(ids, std::set{std::this_thread::get_id()}) << "the caller's own thread";
    }
  }
}

TEST(ParallelFor, NoChunkIsBegunAfterAnError) {
  // One thread takes chunks in order, so it is known which ones have begun.
  std::size_t begun = 0;
  EXPECT_THROW(parallel_for({.threads = 1}, 100, 1,
                            [&](std::size_t, std::size_t) {
                              if (++begun == 18) throw Error(ErrorCode::bad_argument, "eighteen");
                            }),
               Error);
  EXPECT_EQ(begun, 18u);
}

#if defined(__SSE2__)
// Callers that play sound or games often set the processor to flush tiny numbers to zero.
TEST(ParallelFor, TinyNumbersAreNumbersWhateverTheCallerSet) {
  constexpr unsigned flush_to_zero = 0x8040;
  for (const int threads : {1, 2}) {
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | flush_to_zero);
    std::atomic<int> lost{0};
    parallel_for({.threads = threads}, 16, 1, [&](std::size_t, std::size_t) {
      volatile float tiny = std::numeric_limits<float>::min();
      if (tiny / 4 == 0) ++lost;
    });
    EXPECT_EQ(_mm_getcsr() & flush_to_zero, flush_to_zero) << "the caller's own setting was not given back";
    _mm_setcsr(before);
    EXPECT_EQ(lost, 0) << threads << " threads";
  }
}
#endif

TEST(Watch, IsToldAndAskedOnlyIfItIsThere) {
  EXPECT_NO_THROW(check_cancelled({}));
  EXPECT_NO_THROW(report_progress({}, "stage", 0.5));
  const Watch empty;
  EXPECT_NO_THROW(check_cancelled({.watch = &empty}));
  EXPECT_NO_THROW(report_progress({.watch = &empty}, "stage", 0.5));
  std::string told;
  const Watch watch{.progress = [&](std::string_view stage,
                                    double part) { told = std::string(stage) + (part == 0.5 ? " half" : ""); },
                    .cancelled = [] { return true; }};
  report_progress({.watch = &watch}, "stage", 0.5);
  EXPECT_EQ(told, "stage half");
  try {
    check_cancelled({.watch = &watch});
    FAIL() << "it says that it is cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
    EXPECT_STREQ(error.what(), "cancelled");
  }
}

}  // namespace
}  // namespace frontmost
