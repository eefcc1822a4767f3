// SPDX-License-Identifier: Apache-2.0
// Keys between vertices, compared with exact sums.
#include "view/triangle_keys.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;

struct KeyedTriangle {
  std::int32_t x[3], y[3];
  float key[3];
};

KeyedTriangle turned(const KeyedTriangle& t, const std::array<int, 3>& order) {
  KeyedTriangle r;
  for (std::size_t k = 0; k < 3; ++k) r.x[k] = t.x[order[k]], r.y[k] = t.y[order[k]], r.key[k] = t.key[order[k]];
  return r;
}

KeyedTriangle with_positive_area(const KeyedTriangle& t) { return doubled_area(t) < 0 ? turned(t, {0, 2, 1}) : t; }

Rational exact_key(const KeyedTriangle& t, std::int64_t x, std::int64_t y) {
  Rational sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;  // the edge opposite to vertex k
    const std::int64_t edge =
        std::int64_t(t.x[b] - t.x[a]) * (y - t.y[a]) - std::int64_t(t.y[b] - t.y[a]) * (x - t.x[a]);
    sum += Rational(edge) * Rational(t.key[k]);
  }
  return sum / doubled_area(t);
}

bool is_inside(const KeyedTriangle& t, std::int64_t x, std::int64_t y) {
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3;
    if (std::int64_t(t.x[b] - t.x[a]) * (y - t.y[a]) - std::int64_t(t.y[b] - t.y[a]) * (x - t.x[a]) < 0) return false;
  }
  return true;
}

/// Triangles as clipping and snapping leave them: up to the guard band, with keys over many powers of two, and many of
/// them needles.
KeyedTriangle random_triangle(Random& random) {
  KeyedTriangle t{};
  const int reach = 1 << (4 + random.below(18));
  for (std::size_t k = 0; k < 3; ++k) {
    t.x[k] = random.below(2 * reach) - reach;
    t.y[k] = random.below(2 * reach) - reach;
    t.key[k] = std::ldexp(0.5f + 0.5f * random.unit(), -random.below(1 + random.below(20)));
  }
  if (random.below(2) == 0) {  // a needle: the last vertex is close to the edge between the others
    const float s = random.unit();
    t.x[2] = t.x[0] + std::int32_t(s * float(t.x[1] - t.x[0])) + random.below(3) - 1;
    t.y[2] = t.y[0] + std::int32_t(s * float(t.y[1] - t.y[0])) + random.below(3) - 1;
  }
  if (random.below(4) == 0) t.key[1] = t.key[0];
  if (random.below(4) == 0)  // a gentle plane
    for (float& key : t.key) key = 0.5f + 0.1f * key;
  return t;
}

/// A point of the triangle, by random weights of its vertices.
glm::ivec2 random_point(const KeyedTriangle& t, Random& random) {
  double a = random.unit(), b = random.unit();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  return {std::int32_t(std::lround(t.x[0] + a * (t.x[1] - t.x[0]) + b * (t.x[2] - t.x[0]))),
          std::int32_t(std::lround(t.y[0] + a * (t.y[1] - t.y[0]) + b * (t.y[2] - t.y[0])))};
}

TEST(TriangleKeys, AreThePlaneThroughTheCornersToAFewRoundings) {
  Random random(1);
  std::size_t gentle = 0, steep = 0;
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    const KeyedTriangle t = with_positive_area(random_triangle(random));
    if (doubled_area(t) == 0) continue;
    const glm::ivec2 at = random_point(t, random);
    if (!is_inside(t, at.x, at.y)) continue;
    const bool is_steep = KeyPlane(t).is_steep;
    ++(is_steep ? steep : gentle);
    const Rational key = exact_key(t, at.x, at.y), found(TriangleKeys(t).at(at.x, at.y));
    const double error = double(abs(found - key) / key) * 0x1p24;
    ASSERT_LE(error, is_steep ? 1.001 : 16) << i;
    worst = std::max(worst, error);
  }
  EXPECT_GT(gentle, 1000u);
  EXPECT_GT(steep, 10000u);
  EXPECT_GT(worst, 0.5) << "the sum became too good to be one of floats: is anything tested?";
}

TEST(TriangleKeys, DoNotDependOnTheOrderOfTheCorners) {
  Random random(2);
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::size_t compared = 0;
  for (int i = 0; i < 40000; ++i) {
    const KeyedTriangle t = random_triangle(random);
    if (doubled_area(t) == 0) continue;
    const glm::ivec2 at = random_point(t, random) + glm::ivec2(random.below(300), random.below(300));
    const float expected = TriangleKeys(with_positive_area(t)).at(at.x, at.y);
    for (const auto& order : kOrders)
      ASSERT_EQ(TriangleKeys(with_positive_area(turned(t, order))).at(at.x, at.y), expected) << i;
    ++compared;
  }
  EXPECT_GT(compared, 20000u);
}

TEST(TriangleKeys, HaveTheGradientOfTheirPlane) {
  // Round numbers give exact results: a quarter in ten pixels to the right, nothing in y.
  const KeyedTriangle ramp{{0, 2560, 2560}, {0, 0, 2560}, {0.5f, 0.75f, 0.75f}};
  EXPECT_FALSE(KeyPlane(ramp).is_steep);
  EXPECT_EQ(KeyPlane(ramp).gx, 0.25f / 2560);
  EXPECT_EQ(KeyPlane(ramp).gy, 0.0f);
  EXPECT_EQ(KeyPlane(ramp).at(1280, 100), 0.625f);
  EXPECT_EQ(SteepKeys(ramp).gx(), 0.25 / 2560);
  EXPECT_EQ(SteepKeys(ramp).gy(), 0.0);
  EXPECT_EQ(SteepKeys(ramp).at(1280, 100), 0.625f);
}

TEST(TriangleKeys, StayBetweenTheCornersAlsoOutside) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const KeyedTriangle t = with_positive_area(random_triangle(random));
    if (doubled_area(t) == 0) continue;
    const float key = TriangleKeys(t).at(random.below(1 << 20) - (1 << 19), random.below(1 << 20) - (1 << 19));
    const auto [low, high] = std::minmax({t.key[0], t.key[1], t.key[2]});
    ASSERT_TRUE(key >= low && key <= high) << i;
  }
}

}  // namespace
}  // namespace frontmost::test
