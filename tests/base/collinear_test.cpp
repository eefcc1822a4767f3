// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "base/orientation.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

using Limits = std::numeric_limits<float>;

TEST(Collinear, RepeatedCornersAre) {
  const glm::vec3 a(1.1f, -2.3f, 1e30f), b(7e-20f, 3, 4);
  EXPECT_TRUE(are_collinear(a, a, b));
  EXPECT_TRUE(are_collinear(a, b, a));
  EXPECT_TRUE(are_collinear(b, a, a));
  EXPECT_TRUE(are_collinear(a, a, a));
}

TEST(Collinear, PointsOnALineAreAndOneUnitInTheLastPlaceOffIsNot) {
  const glm::vec3 a(0, 0, 0), b(1, 2, 3), c(3, 6, 9);
  EXPECT_TRUE(are_collinear(a, b, c));
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 off = c;
    off[axis] = std::nextafter(off[axis], 100.0f);
    EXPECT_FALSE(are_collinear(a, b, off)) << "axis " << axis;
  }
}

TEST(Collinear, DifferencesThatRoundDoNotFoolIt) {
  // The direction from a to the others needs 150 bits: in floats and doubles, both differences become (1, 1, 1).
  const glm::vec3 a(1e-25f, 2e-25f, 3e-25f);
  EXPECT_FALSE(are_collinear(a, {1, 1, 1}, {2, 2, 2}));
  EXPECT_TRUE(are_collinear({1e-25f, 1e-25f, 1e-25f}, {1, 1, 1}, {2, 2, 2}));
}

TEST(Collinear, HoldsAtBothEndsOfTheRange) {
  const float tiny = Limits::denorm_min(), huge = Limits::max();
  EXPECT_FALSE(are_collinear({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}));
  EXPECT_TRUE(are_collinear({0, 0, 0}, {tiny, tiny, 0}, {3 * tiny, 3 * tiny, 0}));
  EXPECT_FALSE(are_collinear({-huge, -huge, 0}, {huge, huge, 0}, {huge, -huge, huge}));
  EXPECT_TRUE(are_collinear({-huge, -huge, huge}, {huge, huge, -huge}, {0, 0, 0}));
  EXPECT_FALSE(are_collinear({-huge, -huge, huge}, {huge, huge, -huge}, {0, 0, tiny}));
}

// Integers below 2^20 make every term exact in 64 bits: an oracle without expansions.
bool oracle(const glm::i64vec3& a, const glm::i64vec3& b, const glm::i64vec3& c) {
  const glm::i64vec3 u = b - a, v = c - a;
  return u.x * v.y == u.y * v.x && u.y * v.z == u.z * v.y && u.z * v.x == u.x * v.z;
}

TEST(Collinear, AgreesWithIntegersOnPointsNearAndOnLines) {
  std::mt19937 random(test::noted_seed(1));
  const auto draw = [&](int limit) { return std::int64_t(random() % std::uint32_t(2 * limit + 1)) - limit; };
  int collinear = 0;
  for (int i = 0; i < 200000; ++i) {
    const glm::i64vec3 a(draw(5000), draw(5000), draw(5000)), step(draw(50), draw(50), draw(50));
    glm::i64vec3 b = a + step * draw(900), c = a + step * draw(900);
    if (i % 2 == 1) c[i % 3] += draw(1);
    // Powers of two scale exactly; other scales would give another line.
    const float scale = std::ldexp(1.0f, int(draw(60)));
    const auto scaled = [&](const glm::i64vec3& p) { return glm::vec3(p) * scale; };
    const bool expected = oracle(a, b, c);
    ASSERT_EQ(are_collinear(scaled(a), scaled(b), scaled(c)), expected) << "draw " << i;
    collinear += expected;
  }
  EXPECT_GT(collinear, 100000);
  EXPECT_LT(collinear, 190000);
}

TEST(Collinear, DoesNotDependOnTheOrderOfCorners) {
  std::mt19937 random(test::noted_seed(2));
  std::uniform_real_distribution<float> draw(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 a(draw(random), draw(random), draw(random)), b(draw(random), draw(random), draw(random));
    const glm::vec3 middle = (a + b) * 0.5f;  // rounded: sometimes on the line, mostly just off it
    const bool first = are_collinear(a, b, middle);
    ASSERT_EQ(are_collinear(middle, a, b), first);
    ASSERT_EQ(are_collinear(b, a, middle), first);
  }
}

}  // namespace
}  // namespace frontmost
