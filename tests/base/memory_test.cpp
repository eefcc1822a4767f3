// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/large_pages.h"
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

}  // namespace
}  // namespace frontmost
