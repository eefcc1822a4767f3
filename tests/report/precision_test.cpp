// SPDX-License-Identifier: Apache-2.0
// Depth precision against closed forms, and against the values that the formats hold.
#include "frontmost/precision.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/odd_numbers.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

constexpr DepthFormat integers[] = {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24};

double depth_at(const DepthSetup& setup, double distance) {
  const auto& [n, f] = setup.clip;
  const double u = setup.orthographic ? (distance - n) / (f - n) : (1 - n / distance) / (1 - n / f);
  return setup.reversed ? 1 - u : u;
}

std::uint32_t stored_at(const DepthSetup& setup, double distance) {
  // 1 - u cancels far away, where reversed floats are finest.
  const auto& [n, f] = setup.clip;
  const double depth =
      setup.reversed && !setup.orthographic ? (n / distance - n / f) / (1 - n / f) : depth_at(setup, distance);
  return stored_depth(setup.format, depth);
}

double steps(DepthFormat format) { return double((std::uint32_t(1) << integer_bits(format)) - 1); }

// near = 1, far = 100, 8 bits: one step is 0.99 / 255 of 1/d, so at 10 the next surface must be 10 / (1 - 0.0388) away.
TEST(ResolvableGap, WorkedExample) {
  const DepthSetup setup{{1, 100}, DepthFormat::d8};
  EXPECT_NEAR(resolvable_gap(setup, 10), 10 / (1 - 10 * 0.99 / 255) - 10, 1e-12);
  EXPECT_NEAR(resolvable_gap(setup, 10), 0.40392, 1e-5);
  EXPECT_NEAR(resolvable_gap(setup, 1), 0.0038975, 1e-6);
}

// Known to OpenGL programmers: d^2 / (near 2^n) if far is much farther than near.
TEST(ResolvableGap, FollowsTheSquareOfTheDistance) {
  for (const bool reversed : {false, true})
    for (const double distance : {0.5, 1.0, 20.0, 900.0}) {
      const DepthSetup setup{{0.1, 1000}, DepthFormat::d24, reversed};
      const double rule = distance * distance / (0.1 * 16777216);
      EXPECT_NEAR(resolvable_gap(setup, distance) / rule, 1, 0.01);
    }
  // 24 bits, near 0.1, far 1000: more than half a unit at 1000.
  EXPECT_NEAR(resolvable_gap({{0.1, 1000}, DepthFormat::d24}, 1000), 0.5963, 1e-3);
}

// A gap changes the stored value by (2^n - 1) f / (f - n) * n gap / (d (d + gap)), which must be exactly one.
TEST(ResolvableGap, IsOneStepOfTheInteger) {
  for (const DepthFormat format : integers)
    for (const double distance : {0.3, 1.0, 7.0, 60.0}) {
      const double n = 0.25, f = 64;
      const double gap = resolvable_gap({{n, f}, format}, distance);
      if (!std::isfinite(gap)) continue;
      EXPECT_NEAR(steps(format) * f / (f - n) * n * gap / (distance * (distance + gap)), 1, 1e-9);
    }
}

TEST(ResolvableGap, ReversedFloatsResolveAShareOfTheDistance) {
  for (const double near : {1e-3, 0.1, 7.0})
    for (double distance = near; distance < 1e9; distance *= 1.7) {
      const double gap = resolvable_gap({{near, kInfinity}, DepthFormat::f32, true}, distance);
      EXPECT_GE(gap, 0.999 * std::ldexp(distance, -24));
      EXPECT_LE(gap, 1.001 * std::ldexp(distance, -23));
    }
}

TEST(ResolvableGap, FloatsThatAreNotReversedAreNoBetterThan24BitsFarAway) {
  const ClipDistances clip{0.1, 1000};
  for (const double distance : {1.0, 10.0, 500.0}) {
    const double as_float = resolvable_gap({clip, DepthFormat::f32}, distance);
    EXPECT_NEAR(as_float / resolvable_gap({clip, DepthFormat::d24}, distance), 1, 0.01);
  }
}

TEST(ResolvableGap, FloatsAreNeverFinerThanTheKeysTheyAreMadeFrom) {
  for (const bool reversed : {false, true})
    for (const double distance : {0.1, 0.13, 999.0, 1000.0}) {
      const double gap = resolvable_gap({{0.1, 1000}, DepthFormat::f32, reversed}, distance);
      EXPECT_GE(gap, 0.999 * std::ldexp(distance, -24)) << distance;
      if (!reversed && distance > 1) continue;
      EXPECT_LE(gap, 1.001 * std::ldexp(distance, -23)) << distance;
    }
}

TEST(ResolvableGap, ParallelDepthIsEven) {
  for (const bool reversed : {false, true})
    EXPECT_NEAR(resolvable_gap({{0, 255}, DepthFormat::d8, reversed, true}, 77), 1, 1e-12);
  EXPECT_NEAR(resolvable_gap({{-5, 5}, DepthFormat::d16, false, true}, 0), 10 / 65535.0, 1e-12);
}

// The promise: a surface farther by the gap has another stored value, at any distance.
TEST(ResolvableGap, SurfacesAGapApartNeverShareAValue) {
  Random random(3);
  std::size_t tried = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double near = std::exp(double(random.within(-5, 2)));
    const double far = random.below(3) ? near * std::exp(double(random.within(0.5f, 9))) : kInfinity;
    const DepthSetup setup{{near, far}, DepthFormat(random.below(4)), random.below(2) == 1};
    const double distance = near * std::exp(double(random.unit()) * std::log(std::min(far / near, 1e5)));
    if (!(distance > near && distance < far)) continue;
    // The gap must not vanish in the test's own doubles.
    const double gap = std::max(resolvable_gap(setup, distance) * (1 + 1e-9), distance * 1e-12);
    if (!(distance + gap < far)) continue;
    ++tried;
    ASSERT_NE(stored_at(setup, distance), stored_at(setup, distance + gap))
        << "format " << int(setup.format) << (setup.reversed ? " reversed" : "") << " near " << near << " far " << far
        << " at " << distance << " gap " << gap;
  }
  EXPECT_GT(tried, 100'000u);
}

// Over all values of a format in turn: neighbours are never farther apart than the gap.
TEST(ResolvableGap, CoversEveryPairOfNeighbouringValues) {
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16})
    for (const bool reversed : {false, true}) {
      const DepthSetup setup{{0.5, 300}, format, reversed};
      const Projection p = make_projection(1.0, 1.0, setup.clip);
      const DepthConvention convention = reversed ? reversed_depth : zero_to_one_depth;
      const std::uint32_t last = std::uint32_t(steps(format));
      for (std::uint32_t i = 0; i < last; ++i) {
        const std::uint32_t value = reversed ? last - i : i, next = reversed ? value - 1 : value + 1;
        const double here = distance_of_depth(p, convention, depth_of_stored(format, value));
        const double there = distance_of_depth(p, convention, depth_of_stored(format, next));
        const double gap = resolvable_gap(setup, std::clamp(here, 0.5, 300.0));
        ASSERT_NEAR(gap / (there - here), 1, 1e-6) << value;
      }
    }
}

// Neighbouring floats are never farther apart than the gap either.
TEST(ResolvableGap, CoversNeighbouringFloats) {
  for (const bool reversed : {false, true}) {
    const DepthSetup setup{{0.5, kInfinity}, DepthFormat::f32, reversed};
    Random random(9);
    for (int i = 0; i < 20'000; ++i) {
      // Below a half, the keys 1 - depth are coarser than the depths.
      const float depth = random.within(reversed ? 1e-4f : 0.5f, 0.9999f);
      const float next = std::nextafter(depth, reversed ? 0.0f : 2.0f);
      const auto distance = [&](float z) { return 0.5 / (reversed ? double(z) : 1 - double(z)); };
      const double between = distance(next) - distance(depth);
      const double gap = resolvable_gap(setup, distance(depth));
      // Just above a power of two, the spacing to the next float halves or doubles.
      ASSERT_GE(gap, between * (1 - 1e-6) - 1e-15);
      ASSERT_LE(gap, between * 2 * (1 + 1e-3) + 1e-15);
    }
  }
}

TEST(NearForGap, MeetsTheGapAndNoLessDoes) {
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::f32})
    for (const double far : {1000.0, kInfinity})
      for (const auto& [distance, gap] : {std::pair(100.0, 0.5), {900.0, 0.01}, {10.0, 0.002}}) {
        const DepthSetup setup{{1e-3, far}, format};
        const std::optional<double> near = near_for_gap(setup, distance, gap);
        if (!near) {
          // Even a near plane at the surface itself would not suffice.
          EXPECT_GT(resolvable_gap({{distance, far}, format}, distance), gap);
          continue;
        }
        EXPECT_LE(resolvable_gap({{*near * 1.0001, far}, format}, distance), gap);
        EXPECT_GT(resolvable_gap({{*near * 0.999, far}, format}, distance), gap);
      }
  // 24 bits, infinite far: near = d (d + gap) / (gap (2^24 - 1)).
  EXPECT_NEAR(*near_for_gap({{0.1, kInfinity}, DepthFormat::d24}, 1000, 0.1), 1000 * 1000.1 / (0.1 * 16777215), 1e-9);
  EXPECT_EQ(near_for_gap({{0.1, kInfinity}, DepthFormat::f32, true}, 1000, 0.001), 0);
  EXPECT_EQ(near_for_gap({{0.1, kInfinity}, DepthFormat::f32, true}, 1000, 1e-6), std::nullopt);
  EXPECT_EQ(near_for_gap({{0.1, kInfinity}, DepthFormat::d8}, 1000, 1e-3), std::nullopt);
}

TEST(ShareOfValues, HalfOfTheDepthsEndAtTwiceTheNearDistance) {
  EXPECT_NEAR(share_of_values({{0.1, kInfinity}, DepthFormat::d24}, 0.2), 0.5, 1e-12);
  EXPECT_NEAR(share_of_values({{0.1, kInfinity}, DepthFormat::d24, true}, 1), 0.9, 1e-12);
  // 126 of 127 binades of floats lie below a half.
  EXPECT_NEAR(share_of_values({{0.1, kInfinity}, DepthFormat::f32}, 0.2), 126.0 / 127, 1e-6);
  EXPECT_NEAR(share_of_values({{0.1, kInfinity}, DepthFormat::f32, true}, 0.2), 1.0 / 127, 1e-6);
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::f32})
    for (const bool reversed : {false, true}) {
      EXPECT_NEAR(share_of_values({{2, 50}, format, reversed}, 2), 0, 1e-12);
      EXPECT_NEAR(share_of_values({{2, 50}, format, reversed}, 50), 1, 1e-12);
    }
}

TEST(RoundDistances, AreOneTwoFiveBetweenThePlanes) {
  EXPECT_EQ(round_distances({0.3, 4}), (std::vector<double>{0.3, 0.5, 1, 2, 4}));
  EXPECT_EQ(round_distances({0.1, 1}), (std::vector<double>{0.1, 0.2, 0.5, 1}));
  EXPECT_EQ(round_distances({0.1, kInfinity}).back(), 1e5);
  EXPECT_LE(round_distances({1e-30, 1e30}).size(), 205u);
}

TEST(Precision, BadArgumentsAreNamed) {
  const auto message = [](const DepthSetup& setup, double distance) -> std::string {
    try {
      (void)resolvable_gap(setup, distance);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message({{0, 10}}, 5), "near: must be greater than 0 in perspective");
  EXPECT_EQ(message({{2, 1}}, 1), "far: must be greater than near");
  EXPECT_EQ(message({{1, 10}}, 11), "distance: must lie between near and far");
  EXPECT_EQ(message({{1, kInfinity}}, kInfinity), "distance: must lie between near and far");
  EXPECT_THROW((void)near_for_gap({{1, 10}}, 5, 0), Error);
}

}  // namespace
}  // namespace frontmost::test
