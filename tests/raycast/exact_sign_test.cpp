// SPDX-License-Identifier: Apache-2.0
// Signs of determinants, against 128-bit integers.
#include <gtest/gtest.h>

#include "raycast/query/queries.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using raycast_detail::determinant_sign;
using raycast_detail::high_low;
using raycast_detail::high_low_difference;

__extension__ using Int128 = __int128;

int sign_of(Int128 v) { return int(v > 0) - int(v < 0); }

/// Coordinates are integers below 2^24, so floats hold them and 128 bits hold the determinant.
Int128 determinant(const glm::vec3& o, const std::array<glm::vec3, 3>& p) {
  Int128 m[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) m[i][k] = Int128(p[std::size_t(i)][k]) - Int128(o[k]);
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

glm::vec3 whole_point(Random& random, int reach) {
  return {float(random.below(2 * reach) - reach), float(random.below(2 * reach) - reach),
          float(random.below(2 * reach) - reach)};
}

TEST(ExactSign, EqualsWholeNumbers) {
  std::size_t zeros = 0;
  for (std::uint64_t seed = 0; seed < 200'000; ++seed) {
    Random random(seed);
    const int reach = seed % 3 == 0 ? 3 : seed % 3 == 1 ? 1000 : 1 << 23;
    const glm::vec3 o = whole_point(random, reach);
    std::array<glm::vec3, 3> p{whole_point(random, reach), whole_point(random, reach), {}};
    // Half of them are nearly coplanar: the third point is the middle of the other two, as far as integers allow.
    p[2] = seed % 2 ? whole_point(random, reach) : glm::floor((p[0] + p[1]) * 0.5f);
    const Int128 expected = determinant(o, p);
    zeros += expected == 0;
    ASSERT_EQ(
        determinant_sign(high_low_difference(p[0], o), high_low_difference(p[1], o), high_low_difference(p[2], o)),
        sign_of(expected))
        << "seed " << seed;
  }
  EXPECT_GT(zeros, 1000u);
}

TEST(ExactSign, SeesTheLastBit) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(determinant_sign(high_low(x), high_low(y), high_low(z)), 1);
  EXPECT_EQ(determinant_sign(high_low(y), high_low(x), high_low(z)), -1);
  EXPECT_EQ(determinant_sign(high_low(x), high_low(y), high_low(glm::vec3(1, 1, 0))), 0);
  // Denormals: products far below what floats hold.
  const float tiny = 1e-40f;
  EXPECT_EQ(determinant_sign(high_low(tiny * x), high_low(tiny * y), high_low(-tiny * z)), -1);
  // The eye is 1e30 to the left of three points in the plane x = 0. Moving one of them by 1e-30 makes no difference in
  // doubles: the distance is 1e30 either way. Without that move, the three columns are dependent.
  const glm::vec3 eye(-1e30f, 0, 0);
  const auto from_eye = [&](const glm::vec3& p) { return high_low_difference(p, eye); };
  EXPECT_EQ(determinant_sign(from_eye({0, 1, 0}), from_eye({0, 1, 1}), from_eye({0, 1, 2})), 0);
  EXPECT_EQ(determinant_sign(from_eye({0, 1, 0}), from_eye({1e-30f, 1, 1}), from_eye({0, 1, 2})), -1);
  EXPECT_EQ(determinant_sign(from_eye({0, 1, 0}), from_eye({-1e-30f, 1, 1}), from_eye({0, 1, 2})), 1);
}

}  // namespace
}  // namespace frontmost::test
