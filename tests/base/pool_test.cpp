// SPDX-License-Identifier: Apache-2.0
#include "base/pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <set>
#include <thread>
#include <vector>

namespace frontmost::test {
namespace {

TEST(Pool, LendsAThingAgainOnceItIsBack) {
  Pool<int> pool;
  int made = 0;
  const auto make = [&] { return std::make_unique<int>(++made); };
  for (int round = 0; round < 3; ++round) {
    const auto first = pool.borrow(make), second = pool.borrow(make);
    EXPECT_NE(first.operator->(), second.operator->());
    EXPECT_EQ((std::set{*first, *second}), (std::set{1, 2}));
  }
  EXPECT_EQ(made, 2);
}

TEST(Pool, NoTwoThreadsHoldTheSameThing) {
  struct Thing {
    std::atomic<int> holders{0};
  };
  Pool<Thing> pool;
  std::atomic<int> shared{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int round = 0; round < 2000; ++round) {
        const auto thing = pool.borrow([] { return std::make_unique<Thing>(); });
        if (thing->holders.fetch_add(1) != 0) ++shared;
        thing->holders.fetch_sub(1);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(shared, 0);
}

TEST(Pool, WhatCannotBeMadeIsNotLent) {
  Pool<int> pool;
  EXPECT_THROW((void)pool.borrow([]() -> std::unique_ptr<int> { throw std::bad_alloc(); }), std::bad_alloc);
  EXPECT_EQ(*pool.borrow([] { return std::make_unique<int>(7); }), 7);
}

}  // namespace
}  // namespace frontmost::test
