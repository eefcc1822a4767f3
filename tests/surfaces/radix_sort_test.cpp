// SPDX-License-Identifier: Apache-2.0
#include "surfaces/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/seeds.h"

namespace frontmost::test {
namespace {

Buffer<std::uint64_t> random_items(std::size_t count, int key_bits) {
  std::mt19937_64 random(test::noted_seed(count));
  Buffer<std::uint64_t> items(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t above = random() << 32 << key_bits;  // bits beside the key must not count
    items[i] = (key_bits < 32 ? above : 0) | (random() >> (64 - key_bits)) << 32 | i;
  }
  return items;
}

TEST(RadixSort, EqualsAStableSortForEveryWidthOfKeys) {
  for (const std::size_t count : {0, 1, 2, 1000, 200'000})
    for (const int key_bits : {1, 11, 12, 22, 23, 32}) {
      SCOPED_TRACE(testing::Message() << count << " items, " << key_bits << " bits");
      const Buffer<std::uint64_t> items = random_items(count, key_bits);
      std::vector<std::uint64_t> expected(items.begin(), items.end());
      const auto key = [&](std::uint64_t item) { return item << (32 - key_bits) >> (64 - key_bits); };
      std::stable_sort(expected.begin(), expected.end(), [&](auto a, auto b) { return key(a) < key(b); });
      for (const int threads : {1, 3}) {
        const Buffer<std::uint64_t> sorted = radix_sort(items, key_bits, {.threads = threads});
        ASSERT_EQ(sorted.size(), count);
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], expected[i]) << i;
      }
    }
}

}  // namespace
}  // namespace frontmost::test
