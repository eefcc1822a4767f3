// SPDX-License-Identifier: Apache-2.0
#include "base/orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/seeds.h"

namespace frontmost {
namespace {

TEST(Orientation, IsExact) {
  // Integers up to 2^24 are exact floats, and their orientation fits 128 bits; one point lies near the line of the
  // others.
  std::mt19937_64 random(test::noted_seed(3));
  const auto integer = [&](std::int64_t range) {
    return std::int64_t(random() % std::uint64_t(2 * range + 1)) - range;
  };
  std::size_t zeros = 0;
  for (int i = 0; i < 200'000; ++i) {
    const std::int64_t ax = integer(1 << 20), ay = integer(1 << 20), dx = integer(1 << 10), dy = integer(1 << 10);
    const std::int64_t s = integer(1000), t = integer(1000);
    const std::int64_t bx = ax + s * dx, by = ay + s * dy, cx = ax + t * dx + integer(1), cy = ay + t * dy;
    const __int128 exact = __int128(bx - ax) * (cy - ay) - __int128(by - ay) * (cx - ax);
    const int sign = exact > 0 ? 1 : (exact < 0 ? -1 : 0);
    zeros += sign == 0;
    // Scaling by a power of two changes nothing.
    const float scale = std::ldexp(1.0f, int(random() % 80) - 40);
    ASSERT_EQ(orientation(glm::vec2(ax, ay) * scale, glm::vec2(bx, by) * scale, glm::vec2(cx, cy) * scale), sign);
  }
  EXPECT_GT(zeros, 50'000u);
}

TEST(Orientation, SeesTheLastBitFarFromTheOrigin) {
  const float big = 1e30f, tiny = 1e-30f;
  EXPECT_EQ(orientation({-big, -big}, {big, big}, {tiny, tiny}), 0);
  EXPECT_EQ(orientation({-big, -big}, {big, big}, {tiny, 2 * tiny}), 1);
  EXPECT_EQ(orientation({-big, -big}, {big, big}, {2 * tiny, tiny}), -1);
}

TEST(Orientation, HoldsAtBothEndsOfTheRangeOfFloats) {
  const float tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
  EXPECT_EQ(orientation({0, 0}, {tiny, 0}, {0, tiny}), 1);
  EXPECT_EQ(orientation({0, 0}, {0, tiny}, {tiny, 0}), -1);
  EXPECT_EQ(orientation({0, 0}, {tiny, tiny}, {3 * tiny, 3 * tiny}), 0);
  EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {huge, -huge}), -1);
  EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {0, tiny}), 1);
}

TEST(Orientation, TurnsRoundWithItsCornersAndBackWithTwoOfThem) {
  std::mt19937 random(test::noted_seed(4));
  std::uniform_real_distribution<float> draw(-1, 1);
  int on_a_line = 0;
  for (int i = 0; i < 50'000; ++i) {
    const glm::vec2 a(draw(random), draw(random)), b(draw(random), draw(random)), c = (a + b) * 0.5f;
    const int turn = orientation(a, b, c);
    on_a_line += turn == 0;
    ASSERT_EQ(orientation(b, c, a), turn);
    ASSERT_EQ(orientation(c, a, b), turn);
    ASSERT_EQ(orientation(b, a, c), -turn);
  }
  EXPECT_GT(on_a_line, 1000);
  EXPECT_LT(on_a_line, 49'000);
}

}  // namespace
}  // namespace frontmost
