// SPDX-License-Identifier: Apache-2.0
#include "report/group.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "support/seeds.h"

namespace frontmost {
namespace {

// An order-free summary of all groups, to compare two runs.
struct Summary {
  std::uint64_t groups = 0, items = 0, hash = 0;
  Summary& operator+=(const Summary& other) {
    groups += other.groups, items += other.items, hash += other.hash;
    return *this;
  }
  friend bool operator==(const Summary&, const Summary&) = default;
};

using Keys = std::vector<std::array<std::uint32_t, 3>>;

Summary summary_of(const Keys& keys, int threads) {
  const auto produce = [&](std::size_t i, Keyed& item) {
    if (keys[i][0] == 13) return false;  // left out
    item = Keyed(keys[i][0], keys[i][1], keys[i][2], std::uint32_t(i));
    return true;
  };
  return for_each_group<Summary>({.threads = threads}, keys.size(), produce,
                                 [&](std::span<const Keyed> group, Summary& sum) {
                                   ++sum.groups;
                                   sum.items += group.size();
                                   std::uint64_t hash = 17;
                                   for (std::size_t i = 0; i < group.size(); ++i) {
                                     EXPECT_EQ(keys[group[i].carried()], keys[group[0].carried()]);
                                     EXPECT_TRUE(i == 0 || group[i - 1].carried() < group[i].carried());
                                     hash = (hash ^ group[i].carried()) * 0x100000001B3u;
                                   }
                                   sum.hash += hash;
                                 });
}

Summary expected_of(const Keys& keys) {
  std::map<std::array<std::uint32_t, 3>, std::vector<std::uint32_t>> groups;
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    if (keys[i][0] != 13) groups[keys[i]].push_back(i);
  Summary sum;
  for (const auto& [key, members] : groups) {
    ++sum.groups;
    sum.items += members.size();
    std::uint64_t hash = 17;
    for (const std::uint32_t i : members) hash = (hash ^ i) * 0x100000001B3u;
    sum.hash += hash;
  }
  return sum;
}

TEST(Group, FindsWhatAMapFindsForAnyNumberOfThreads) {
  std::mt19937 random(test::noted_seed(3));
  for (const std::size_t count : {0, 1, 2, 1000, 100000}) {
    for (const std::uint32_t range : {1u, 20u, 0xFFFFFFFFu}) {
      Keys keys(count);
      for (auto& key : keys)
        for (std::uint32_t& k : key) k = std::uint32_t(random()) % range;
      const Summary expected = expected_of(keys);
      for (const int threads : {1, 2, 7}) EXPECT_EQ(summary_of(keys, threads), expected) << count << " of " << range;
    }
  }
}

TEST(Group, KeepsKeysApartThatDifferInOneBit) {
  Keys keys;
  for (int k = 0; k < 3; ++k)
    for (int bit = 0; bit < 32; ++bit) {
      keys.push_back({0, 0, 0});
      keys.back()[std::size_t(k)] = 1u << bit;
    }
  EXPECT_EQ(summary_of(keys, 1).groups, 96u);
}

}  // namespace
}  // namespace frontmost
