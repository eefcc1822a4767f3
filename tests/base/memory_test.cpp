// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <thread>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {
namespace {

constexpr std::size_t kMebi = std::size_t(1) << 20;

TEST(Buffer, IsAlignedAndHoldsWhatIsWritten) {
  for (const std::size_t size :
       {std::size_t(1), std::size_t(4096), 2 * kMebi - 1, 2 * kMebi, 3 * kMebi, 5 * kMebi + 7}) {
    Buffer<std::uint8_t> buffer(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % 64, 0u);
    for (std::size_t i = 0; i < size; ++i) buffer[i] = std::uint8_t(i * 7);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(buffer[i], std::uint8_t(i * 7)) << size;
  }
}

TEST(LargePages, ReservingKeepsWhatIsThere) {
  std::vector<std::uint32_t> values(1000);
  std::iota(values.begin(), values.end(), 0u);
  for (const std::size_t count : {std::size_t(10), std::size_t(2000), 3 * kMebi}) {
    reserve_large(values, count, {.threads = 2});
    EXPECT_GE(values.capacity(), count);
    ASSERT_EQ(values.size(), 1000u);
    for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(values[i], i);
  }
  values.resize(3 * kMebi);
  EXPECT_EQ(values.back(), 0u);
}

TEST(LargePages, AnyRangeMayBeAskedFor) {
  std::vector<std::uint8_t> values(5 * kMebi, 9);
  want_large_pages(values.data() + 1, values.size() - 1);
  want_large_pages(values.data() + 4097, 1);
  want_large_pages(nullptr, 0);
  populate_pages(values.data() + 1, values.size() - 1, {.threads = 3});
  populate_pages(nullptr, 0, {});
  EXPECT_EQ(std::count(values.begin(), values.end(), 9), std::ptrdiff_t(values.size()));
}

using Bytes = Buffer<std::uint8_t>;

class ArenaWithRoom : public testing::Test {
 protected:
  void SetUp() override {
    if (!Arena::has_room) GTEST_SKIP() << "arenas have no room under AddressSanitizer";
  }
};

TEST_F(ArenaWithRoom, BuffersLieSideBySide) {
  const Arena arena(4 * kMebi);
  const Bytes first(1000), second(kMebi), third(7);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(second.data()) % 64, 0u);
  EXPECT_GE(second.data(), first.end());
  EXPECT_LE(second.data(), first.end() + 256);
  EXPECT_GE(third.data(), second.end());
  EXPECT_LE(third.data(), second.end() + 256);
}

TEST_F(ArenaWithRoom, RoomComesBackInWhateverOrderBuffersGo) {
  const Arena arena(4 * kMebi);
  const std::uint8_t* start = Bytes(1).data();
  for (const std::array<int, 3> order : {std::array{0, 1, 2}, {2, 1, 0}, {1, 0, 2}, {1, 2, 0}}) {
    Bytes buffers[3];
    for (Bytes& buffer : buffers) buffer = Bytes(kMebi, 5);
    EXPECT_EQ(buffers[0].data(), start);
    for (const int i : order) buffers[i] = Bytes();
  }
  const Bytes below(1);
  EXPECT_EQ(below.data(), start);
  const std::uint8_t* above = Bytes(1).data();
  EXPECT_EQ(Bytes(1).data(), above);
}

TEST(Arena, WhatHasNoRoomLiesElsewhere) {
  const Arena arena(kMebi);
  for (int round = 0; round < 2; ++round) {
    std::vector<Bytes> buffers;
    for (int i = 0; i < 30; ++i) buffers.emplace_back(kMebi / 10, std::uint8_t(i));
    for (int i = 0; i < 30; ++i)
      EXPECT_EQ(std::count(buffers[i].begin(), buffers[i].end(), i), std::ptrdiff_t(kMebi / 10));
  }
  const Arena none(0);
  EXPECT_EQ(Bytes(5, 3)[4], 3);
  EXPECT_THROW((void)detail::allocate(~std::size_t(0)), std::bad_alloc);
}

TEST_F(ArenaWithRoom, InnerOnesGoFirst) {
  const Arena outer(kMebi);
  const Bytes before(1);
  std::optional<Bytes> kept;
  {
    const Arena inner(kMebi);
    kept.emplace(1000, std::uint8_t(7));
    EXPECT_TRUE(kept->data() < before.data() || kept->data() > before.data() + kMebi);
  }
  EXPECT_EQ(std::count(kept->begin(), kept->end(), 7), 1000) << "it outlives its arena";
  const Bytes after(1);
  EXPECT_LE(after.data(), before.end() + 256);
}

TEST_F(ArenaWithRoom, OtherThreadsHaveNoneAndMayDrop) {
  const Arena arena(kMebi);
  std::vector<Bytes> mine, others;
  for (int i = 0; i < 100; ++i) mine.emplace_back(1000, std::uint8_t(i));
  const std::uint8_t *begin = mine.front().data(), *end = mine.back().end();
  std::thread([&, dropped = std::move(mine)]() mutable {
    for (int i = 0; i < 100; ++i) others.emplace_back(1000, std::uint8_t(i));
    dropped.clear();
  }).join();
  for (const Bytes& buffer : others) EXPECT_TRUE(buffer.end() <= begin || buffer.data() >= end);
  EXPECT_EQ(Bytes(1).data(), begin) << "all room is back";
}

}  // namespace
}  // namespace frontmost
