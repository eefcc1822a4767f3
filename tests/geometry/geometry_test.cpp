// SPDX-License-Identifier: Apache-2.0
// Equal positions, edges, sets and buckets against brute force over all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "geometry/buckets.h"
#include "geometry/disjoint_sets.h"
#include "geometry/edge_neighbours.h"
#include "geometry/places.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

/// Positions with many duplicates, zeros of both signs, and values that are not finite.
std::vector<glm::vec3> some_positions(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<glm::vec3> positions;
  const float values[] = {0.0f, -0.0f, 1.0f, 1e-40f, -3.5f, kInfinite, kNan};
  const auto some = [&] { return values[random.below(random.below(8) == 0 ? 7 : 5)]; };
  for (int i = 0; i < count; ++i) {
    const float x = some(), y = some(), z = some();
    positions.emplace_back(x, y, z);
  }
  return positions;
}

TEST(Places, TheFirstOfEqualOnesIsFoundAsByAllPairs) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<glm::vec3> positions = some_positions(seed, 300);
    const Buffer<std::uint32_t> first = first_at_place(positions, {.threads = int(seed % 3) + 1});
    ASSERT_EQ(first.size(), positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      std::uint32_t expected = 0;
      const auto is_same = [&](std::uint32_t other) { return other == v || positions[other] == positions[v]; };
      while (!is_finite(positions[v]) ? expected != v : !is_same(expected)) ++expected;
      ASSERT_EQ(first[v], expected) << "seed " << seed << ", vertex " << v;
    }
  }
  EXPECT_TRUE(first_at_place({}, {}).empty());
}

TEST(Places, ThreadsThatMeetAtOnePlaceFindTheSame) {
  std::vector<glm::vec3> positions(400000);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = {float(i % 37), float(i % 29), -float(i % 2)};
  for (const int threads : {1, 4}) {
    const Buffer<std::uint32_t> first = first_at_place(positions, {.threads = threads});
    for (std::size_t i = 0; i < positions.size(); ++i) ASSERT_EQ(first[i], i % (37 * 29 * 2)) << threads << " threads";
  }
}

TEST(Places, ManyThatAreNotFiniteAreNotComparedWithEachOther) {
  const std::vector<glm::vec3> positions(400000, glm::vec3(kNan));  // all pairs would take minutes
  const Buffer<std::uint32_t> first = first_at_place(positions, {});
  for (std::uint32_t i = 0; i < first.size(); ++i) ASSERT_EQ(first[i], i);
}

TEST(Places, SortingFindsWhatTheTableFinds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<glm::vec3> positions = some_positions(seed, 500);
    const Buffer<std::uint32_t> table = first_at_place(positions, {}),
                                sorted = detail::first_at_place_by_sorting(positions);
    ASSERT_TRUE(std::equal(table.begin(), table.end(), sorted.begin(), sorted.end())) << "seed " << seed;
  }
}

/// The triangle beyond an edge, by comparison of all pairs of edges.
std::uint32_t beyond_by_all_pairs(const std::vector<glm::uvec3>& triangles, std::size_t t, int k, bool& is_alike) {
  const auto is_whole = [](const glm::uvec3& c) { return c.x != c.y && c.y != c.z && c.z != c.x; };
  if (!is_whole(triangles[t])) return no_index;
  const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
  std::uint32_t found = no_index;
  int count = 0;
  for (std::uint32_t other = 0; other < triangles.size(); ++other) {
    if (other == t || !is_whole(triangles[other])) continue;
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t p = triangles[other][j], q = triangles[other][(j + 1) % 3];
      if (!((p == a && q == b) || (p == b && q == a))) continue;
      found = other;
      is_alike = p == b;
      ++count;
    }
  }
  return count == 1 ? found : no_index;
}

TEST(EdgeNeighbours, AreThoseFoundByAllPairs) {
  int alike = 0, turned = 0, none = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const int vertices = seed % 3 == 0 ? 5 : 40;  // with few vertices, one has many triangles
    std::vector<glm::uvec3> triangles;
    for (int i = 0; i < 60; ++i) {
      const auto a = std::uint32_t(random.below(vertices)), b = std::uint32_t(random.below(vertices)),
                 c = seed % 2 ? std::uint32_t(random.below(vertices)) : 0;
      triangles.emplace_back(a, b, c);
    }
    const EdgeNeighbours neighbours(triangles, std::size_t(vertices), {.threads = int(seed % 2) + 1});
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        bool is_alike = false;
        const std::uint32_t expected = beyond_by_all_pairs(triangles, t, k, is_alike);
        const auto side = std::size_t(k);
        ASSERT_EQ(neighbours.beyond(t, side), expected) << "seed " << seed;
        ASSERT_EQ(neighbours.across(t, side), expected != no_index && is_alike ? expected : no_index);
        if (expected == no_index) {
          ++none;
          continue;
        }
        ASSERT_EQ(neighbours.is_wound_alike(t, side), is_alike);
        ++(is_alike ? alike : turned);
      }
  }
  EXPECT_GT(alike, 200);
  EXPECT_GT(turned, 200);
  EXPECT_GT(none, 200);
}

TEST(EdgeNeighbours, OfALargeGridAreTheSameForAllThreads) {
  constexpr std::uint32_t size = 150;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const std::uint32_t a = y * (size + 1) + x, b = a + 1, c = a + size + 1, d = c + 1;
      triangles.emplace_back(a, b, d);
      triangles.emplace_back(a, d, c);
    }
  for (const int threads : {1, 4}) {
    const EdgeNeighbours neighbours(triangles, (size + 1) * (size + 1), {.threads = threads});
    for (std::uint32_t y = 0; y < size; ++y)
      for (std::uint32_t x = 0; x < size; ++x) {
        const std::uint32_t t = 2 * (y * size + x);
        ASSERT_EQ(neighbours.across(t, 0), y == 0 ? no_index : t - 2 * size + 1);
        ASSERT_EQ(neighbours.across(t, 1), x + 1 == size ? no_index : t + 3);
        ASSERT_EQ(neighbours.across(t, 2), t + 1);
        ASSERT_EQ(neighbours.across(t + 1, 0), t);
      }
  }
}

TEST(DisjointSets, TheLeastNumberLeadsASetWhateverTheOrderAndTheThreads) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (int i = 0; i < 300; ++i) {
      const auto a = std::uint32_t(random.below(500)), b = std::uint32_t(random.below(500));
      pairs.emplace_back(a, b);
    }
    std::vector<std::uint32_t> expected(500);
    for (std::uint32_t i = 0; i < 500; ++i) expected[i] = i;
    for (bool changes = true; changes;) {
      changes = false;
      for (const auto& [a, b] : pairs) {
        const std::uint32_t least = std::min(expected[a], expected[b]);
        changes = changes || expected[a] != least || expected[b] != least;
        expected[a] = expected[b] = least;
      }
    }
    DisjointSets<> sets(500);
    parallel_for({.threads = 4}, pairs.size(), 1,
                 [&](std::size_t i, std::size_t) { sets.join(pairs[i].first, pairs[i].second); });
    for (std::uint32_t i = 0; i < 500; ++i) {
      ASSERT_EQ(sets.leader_of(i), expected[i]) << "seed " << seed;
      ASSERT_EQ(sets.is_leader(i), expected[i] == i);
    }
    DisjointSets<std::greater<>> mirrored(500);  // number i as 499 - i
    std::size_t joined = 0, leaders = 0;
    for (const auto& [a, b] : pairs) joined += mirrored.join(499 - a, 499 - b);
    for (std::uint32_t i = 0; i < 500; ++i) {
      ASSERT_EQ(mirrored.leader_of(499 - i), 499 - expected[i]) << "seed " << seed;
      leaders += mirrored.is_leader(i);
    }
    ASSERT_EQ(joined, 500 - leaders);
  }
}

TEST(Buckets, HoldTheirItemsInTheOrderOfTheirSourcesForAllThreads) {
  const std::size_t sources = 100000, count = 777;
  const auto bucket_of = [](std::size_t source, std::size_t i) { return (source * 7919 + i * 31) % 777; };
  std::vector<std::vector<std::uint64_t>> expected(count);
  for (std::size_t s = 0; s < sources; ++s)
    for (std::size_t i = 0; i < s % 3; ++i) expected[bucket_of(s, i)].push_back(4 * s + i);
  for (const int threads : {1, 2, 5}) {
    const auto list = [&](std::size_t s, const auto& add) {
      for (std::size_t i = 0; i < s % 3; ++i) add(bucket_of(s, i), std::uint64_t(4 * s + i));
    };
    const Buckets<std::uint64_t> buckets(count, sources, list, {.threads = threads});
    ASSERT_EQ(buckets.count(), count);
    for (std::size_t b = 0; b < count; ++b)
      ASSERT_TRUE(std::equal(buckets[b].begin(), buckets[b].end(), expected[b].begin(), expected[b].end())) << b;
  }
  EXPECT_EQ(Buckets<int>().count(), 0u);
  EXPECT_EQ(Buckets<int>(3, 0, [](std::size_t, const auto&) {}, {})[2].size(), 0u);
}

}  // namespace
}  // namespace frontmost::test
