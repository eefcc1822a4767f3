// SPDX-License-Identifier: Apache-2.0
// Threads that persist: all work is done once, whoever does it, also if callers and loops share the threads.
#include "base/crew.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <new>
#include <set>
#include <system_error>

#include "support/effort.h"

namespace frontmost {
namespace {

/// Takes numbers below `count` one by one until none is left, as loops do.
struct Numbers {
  explicit Numbers(int most) : count(most), taken(std::size_t(most)) {}
  template <class Body>
  void drain(const Body& body) {
    for (int i = next++; i < count; i = next++) {
      ++taken[std::size_t(i)];
      body(i);
    }
  }
  [[nodiscard]] bool are_all_taken_once() const {
    return std::all_of(taken.begin(), taken.end(), [](const std::atomic<int>& times) { return times == 1; });
  }
  int count;
  std::atomic<int> next{0};
  std::vector<std::atomic<int>> taken;
};

Crew& crew() { return Crew::of_process(); }

TEST(CrewThreads, AllWorkIsDoneOnce) {
  for (const int helpers : {0, 1, 3, 7})
    for (int round = 0; round < 200; ++round) {
      Numbers numbers(50);
      crew().run(helpers, [&] { numbers.drain([](int) {}); });
      ASSERT_TRUE(numbers.are_all_taken_once());
    }
}

TEST(CrewThreads, HelpersComeAndAreTheSameNextTime) {
  std::set<std::thread::id> seen;
  for (int round = 0; round < 20; ++round) {
    std::mutex mutex;
    std::condition_variable met;
    int inside = 0;
    // No thread leaves before three have come: the caller and two others.
    crew().run(2, [&] {
      std::unique_lock lock(mutex);
      seen.insert(std::this_thread::get_id());
      ++inside;
      met.notify_all();
      met.wait(lock, [&] { return inside == 3; });
    });
  }
  // The test before made at most seven threads.
  EXPECT_GE(seen.size(), 3u);
  EXPECT_LE(seen.size(), 8u);
}

TEST(CrewThreads, LoopsWithinLoopsShareThem) {
  Numbers outer(12);
  std::atomic<int> inner_done{0};
  crew().run(3, [&] {
    outer.drain([&](int) {
      Numbers inner(20);
      crew().run(3, [&] { inner.drain([](int) {}); });
      inner_done += inner.are_all_taken_once();
    });
  });
  EXPECT_TRUE(outer.are_all_taken_once());
  EXPECT_EQ(inner_done, 12);
}

TEST(CrewThreads, AnErrandIsDoneOnce) {
  for (int round = 0; round < 300; ++round) {
    int done = 0;
    Numbers inner(round % 7), meanwhile(round % 5);
    Crew::Errand errand(crew(), [&] {
      crew().run(2, [&] { inner.drain([](int) {}); });
      ++done;
    });
    if (round % 2 == 0) crew().run(3, [&] { meanwhile.drain([](int) {}); });
    errand.wait();
    ASSERT_EQ(done, 1);
    ASSERT_TRUE(inner.are_all_taken_once());
  }
}

TEST(CrewThreads, TheMakerOfAnErrandHelpsInItsLoops) {
  Crew& own = *new Crew;  // has one thread, which does the errand
  std::mutex mutex;
  std::condition_variable met;
  int inside = 0;
  std::atomic<bool> has_begun = false;
  Crew::Errand errand(own, [&] {
    has_begun = true;
    own.run(1, [&] {
      std::unique_lock lock(mutex);
      ++inside;
      met.notify_all();
      met.wait(lock, [&] { return inside == 2; });
    });
  });
  while (!has_begun) std::this_thread::yield();
  errand.wait();
  EXPECT_EQ(inside, 2);
}

TEST(CrewThreads, SeveralCallersShareThem) {
  std::vector<std::thread> callers;
  std::atomic<int> done{0};
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&] {
      for (int round = 0; round < 100; ++round) {
        Numbers numbers(30);
        crew().run(2, [&] { numbers.drain([](int) {}); });
        done += numbers.are_all_taken_once();
      }
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(done, 400);
}

// Loops go on with the threads that there are.
TEST(CrewThreads, TheSystemMayRefuseThreads) {
  static auto& kept = *new std::vector<Crew*>;  // threads wait in a crew until the process ends
  for (const int given : {0, 1, 3})
    for (const bool lacks_memory : {false, true}) {
      std::atomic<int> started{0}, refused{0}, most{given};
      kept.push_back(new Crew([&](std::function<void()> body) {
        if (started == most && ++refused == 1 && lacks_memory) throw std::bad_alloc();
        if (started == most) throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
        ++started;
        std::thread(std::move(body)).detach();
      }));
      for (int round = 0; round < 100; ++round) {
        Numbers numbers(50);
        kept.back()->run(7, [&] { numbers.drain([](int) {}); });
        ASSERT_TRUE(numbers.are_all_taken_once());
      }
      EXPECT_EQ(started, given);
      EXPECT_EQ(refused, 1) << "the system is not asked again at every loop";
      most = 7;
      for (int round = 0; round < 1000; ++round) kept.back()->run(7, [] {});
      EXPECT_EQ(started, 7) << "the system is asked again later";
    }
}

// ThreadSanitizer does not let a process start threads if it was forked from one with several threads.
// AddressSanitizer's memory stays locked in a forked process if another thread was asking for some, such as one that
// just begins.
TEST(Crew, AForkedProcessHasOneOfItsOwn) {
  if (test::under_sanitizer) GTEST_SKIP() << "a sanitizer does not let forked processes start threads";
  crew().run(3, [] {});
  const pid_t child = fork();
  if (child == 0) {
    for (int round = 0; round < 50; ++round) {
      Numbers numbers(100);
      crew().run(3, [&] { numbers.drain([](int) {}); });
      if (!numbers.are_all_taken_once()) _exit(1);
    }
    _exit(0);
  }
  ASSERT_GT(child, 0);
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace frontmost
