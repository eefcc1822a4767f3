// SPDX-License-Identifier: Apache-2.0
// Numbers that are never rounded, and signs computed with them, against fractions.
#include "base/exact_vector.h"

#include <gtest/gtest.h>

#include "support/random_scene.h"
#include "support/rational_vector.h"

namespace frontmost::test {
namespace {

int sign_of(const Rational& r) { return r > 0 ? 1 : r < 0 ? -1 : 0; }

/// A double of random size, often one of a few that cancel each other.
double some_number(Random& random) {
  const int kind = random.below(4);
  const double unit = double(random.within(-1, 1));
  if (kind == 0) return double(random.below(5) - 2);
  return std::ldexp(unit, random.below(80) - 40);
}

TEST(Expansion, SumsAndProductsAreExact) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    Expansion sum;
    Rational exact_sum = 0;
    for (int i = 0; i < 12; ++i) {
      const double a = some_number(random), b = some_number(random);
      const Expansion difference = Expansion::difference(a, b), product = difference * Expansion(a);
      const Rational exact_difference = Rational(a) - Rational(b);
      ASSERT_EQ(difference.sign(), sign_of(exact_difference)) << seed;
      ASSERT_EQ(product.sign(), sign_of(exact_difference * Rational(a))) << seed;
      sum = i % 2 ? sum + product : sum - product;
      exact_sum += (i % 2 ? 1 : -1) * (exact_difference * Rational(a));
      ASSERT_EQ(sum.sign(), sign_of(exact_sum)) << seed << ", " << i;
    }
    // Terms are subtracted again one by one: only an exact sum returns to zero.
    EXPECT_EQ((sum - sum).sign(), 0);
    EXPECT_EQ((sum * sum - sum * sum).sign(), 0);
  }
}

TEST(Expansion, SeesWhatADoubleCannotHold) {
  const Expansion large(1e30), tiny(1e-30);
  EXPECT_EQ((large + tiny - large).sign(), 1);
  EXPECT_EQ((large - tiny - large).sign(), -1);
  EXPECT_EQ((large + tiny - large - tiny).sign(), 0);
  EXPECT_EQ(Expansion().sign(), 0);
  EXPECT_EQ(Expansion(0.0).sign(), 0);
  EXPECT_EQ((-Expansion(3.0)).sign(), -1);
  EXPECT_EQ((Expansion() * large).sign(), 0);
}

TEST(Expansion, ManyTermsGrowBeyondTheFirstFew) {
  // 40 powers of two, 60 bits apart, fit no double; subtracted from the other end, they leave zero.
  Expansion sum;
  for (int i = -20; i < 20; ++i) sum = sum + Expansion(std::ldexp(i % 2 ? 1.0 : -1.0, 25 * i));
  EXPECT_EQ(sum.sign(), 1);  // the sign of 2^475
  const Expansion copy = sum;
  for (int i = 19; i >= -20; --i) sum = sum - Expansion(std::ldexp(i % 2 ? 1.0 : -1.0, 25 * i));
  EXPECT_EQ(sum.sign(), 0);
  EXPECT_EQ(copy.sign(), 1) << "a copy has terms of its own";
}

glm::dvec3 some_point(Random& random) {
  const double x = double(random.within(-1, 1)), y = double(random.within(-1, 1)), z = double(random.within(-1, 1));
  return {x, y, z};
}

int exact_sign(const Leg& a, const Leg& b, const Leg& c) {
  const auto vector = [](const Leg& leg) { return RationalVector(leg.to) - RationalVector(leg.from); };
  return sign_of(dot(cross(vector(a), vector(b)), vector(c)));
}

TEST(SignOfDeterminant, EqualsFractionsHoweverFlatTheThreeAre) {
  std::array<int, 3> signs{};
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    Random random(seed);
    const glm::dvec3 o = some_point(random) * (seed % 5 == 0 ? 1e6 : 1.0);
    const glm::dvec3 a = some_point(random), b = some_point(random);
    // The point lies in the plane of the others, up to the rounding of doubles, or of twice that precision, or exactly.
    const double s = double(random.below(9) - 4) * 0.25, t = double(random.below(9) - 4) * 0.25;
    glm::dvec3 c = o + s * (a - o) + t * (b - o);
    if (seed % 3 == 1) c.z = std::nextafter(c.z, 2e6);
    if (seed % 3 == 2) c = some_point(random);
    const Leg to_a{a, o}, to_b{b, o}, to_c{c, o};
    const int expected = exact_sign(to_a, to_b, to_c);
    ASSERT_EQ(sign_of_determinant(to_a, to_b, to_c), expected) << seed;
    // Even permutations keep the sign, odd ones flip it.
    ASSERT_EQ(sign_of_determinant(to_b, to_c, to_a), expected) << seed;
    ASSERT_EQ(sign_of_determinant(to_b, to_a, to_c), -expected) << seed;
    const int quick = detail::sign_by_double_doubles(to_a, to_b, to_c);
    ASSERT_TRUE(quick == 0 || quick == expected) << seed << ": it may not know, but never be wrong";
    ++signs[std::size_t(expected + 1)];
  }
  for (const int count : signs) EXPECT_GT(count, 100);
}

TEST(SignOfDeterminant, TwiceTheLengthSettlesWhatDoublesLeaveOpen) {
  // A point 2^-51 off the plane of the others: less than the rounding error of products in double.
  const glm::dvec3 x(1, 0, 1), y(0, 1, 1), above(1, 1, 2 + 0x1p-51), in_plane(1, 1, 2);
  EXPECT_EQ(sign_of_determinant({x}, {y}, {above}), 1);
  EXPECT_EQ(detail::sign_by_double_doubles({x}, {y}, {above}), 1);
  EXPECT_EQ(sign_of_determinant({x}, {y}, {in_plane}), 0);
  EXPECT_EQ(detail::sign_by_double_doubles({x}, {y}, {in_plane}), 0);
  EXPECT_EQ(sign_of_determinant({x}, {x}, {above}), 0);
  EXPECT_EQ(sign_of_determinant({glm::dvec3(0)}, {y}, {above}), 0);
}

TEST(SignOfDeterminant, TwoAlongOneLineAreFoundWithoutExpansions) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    // Points are floats, as in meshes. `s` is one too, so the point may be rounded or exact.
    const glm::vec3 o(some_point(random)), way(some_point(random));
    const float s = seed % 2 ? float(random.within(-2, 2)) : 0.25f * float(random.below(16));
    const glm::vec3 a = o + way, b = o + s * way;
    const Leg to_a{glm::dvec3(a), glm::dvec3(o)}, to_b{glm::dvec3(b), glm::dvec3(o)}, to_eye{some_point(random)};
    const RationalVector normal =
        cross(RationalVector(to_a.to) - RationalVector(to_a.from), RationalVector(to_b.to) - RationalVector(to_b.from));
    const bool is_parallel = dot(normal, normal) == 0;
    ASSERT_EQ(detail::are_parallel(to_a, to_b), is_parallel) << seed;
    ASSERT_EQ(sign_of_determinant(to_a, to_b, to_eye), exact_sign(to_a, to_b, to_eye)) << seed;
    found += is_parallel;
  }
  EXPECT_GT(found, 100);
  // The difference does not fit a double: the quick test cannot tell, yet the sign is right.
  const glm::dvec3 far_away(1 + 0x1p-52, 1, 1), near(0x1p-60, 0, 0);
  EXPECT_FALSE(detail::are_parallel({far_away, near}, {far_away, near}));
  EXPECT_EQ(sign_of_determinant({far_away, near}, {far_away, near}, {glm::dvec3(0, 1, 0)}), 0);
}

TEST(CertainSign, IsOpenOnlyWithinTheError) {
  EXPECT_EQ(certain_sign({2, 1}), 1);
  EXPECT_EQ(certain_sign({-2, 1}), -1);
  EXPECT_EQ(certain_sign({1, 1}), 2);
  EXPECT_EQ(certain_sign({-1, 1}), 2);
  EXPECT_EQ(certain_sign({0, 1}), 2);
  EXPECT_EQ(certain_sign({0, 0}), 0);
}

TEST(BoundedNormal, HoldsTheCrossProductWithinItsErrors) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    const glm::dvec3 a = some_point(random), b = seed % 2 ? some_point(random) : a * 3.0;
    const BoundedNormal normal(a, b);
    const RationalVector exact = cross(RationalVector(a), RationalVector(b));
    const Rational off[3] = {exact.x - Rational(normal.value.x), exact.y - Rational(normal.value.y),
                             exact.z - Rational(normal.value.z)};
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(abs(off[axis]), Rational(normal.error[axis])) << seed;
      ASSERT_LT(normal.error[axis], 3e-14) << "no more than a few dozen roundings of numbers up to 3";
    }
    const Bounded product = bounded_dot(normal.value, normal.error, b);
    ASSERT_LE(abs(Rational(product.value)), Rational(product.error)) << seed << ": b lies in the plane";
  }
}

}  // namespace
}  // namespace frontmost::test
