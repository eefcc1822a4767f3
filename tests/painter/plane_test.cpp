// SPDX-License-Identifier: Apache-2.0
// The side of a plane where three others meet, in double-double numbers and exactly.
#include "painter/cutting/plane.h"

#include <gtest/gtest.h>

#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace painter_detail;
using ThreePoints = std::array<glm::dvec3, 3>;

template <class Number>
struct Equation {
  LongVector<Number> n;
  Number d;
};

template <class Number>
Equation<Number> equation(const ThreePoints& p) {
  Equation<Number> e{cross_of(difference_of<Number>(p[1], p[0]), difference_of<Number>(p[2], p[0])), {}};
  e.d = dot_of(e.n, difference_of<Number>(p[0], glm::dvec3(0)));
  return e;
}

/// The determinant of all four planes, expanded along the last column.
template <class Number>
Number determinant(const std::array<ThreePoints, 4>& planes) {
  const Equation<Number> a = equation<Number>(planes[0]), b = equation<Number>(planes[1]),
                         c = equation<Number>(planes[2]), e = equation<Number>(planes[3]);
  return b.d * dot_of(e.n, cross_of(c.n, a.n)) + a.d * dot_of(e.n, cross_of(b.n, c.n)) +
         c.d * dot_of(e.n, cross_of(a.n, b.n)) - e.d * dot_of(a.n, cross_of(b.n, c.n));
}

int exact_side(const std::array<ThreePoints, 4>& planes) {
  const Expansion three = dot_of(equation<Expansion>(planes[0]).n,
                                 cross_of(equation<Expansion>(planes[1]).n, equation<Expansion>(planes[2]).n));
  return determinant<Expansion>(planes).sign() * three.sign();
}

/// Planes through points that are integers, a few units in the last place off, or shared.
std::array<ThreePoints, 4> random_planes(Random& random, int kind) {
  std::array<ThreePoints, 4> planes;
  const glm::dvec3 shared(glm::ivec3(random.point(5)));
  for (ThreePoints& points : planes)
    for (glm::dvec3& point : points) {
      const glm::vec3 at = random.point(4), aside = random.point(1e-6f);
      point = kind == 0 ? glm::dvec3(at) : glm::dvec3(glm::ivec3(at));
      if (kind == 2) point += glm::dvec3(glm::vec3(point) + aside) - point;
    }
  if (kind >= 2)
    for (ThreePoints& points : planes) points[0] = kind == 2 ? shared + glm::dvec3(random.point(1e-7f)) : shared;
  return planes;
}

TEST(PaintPlane, TheSideOfAMeetingIsExact) {
  Random random(5);
  std::size_t asked = 0, zeros = 0, left_open = 0;
  for (int kind = 0; kind < 4; ++kind)
    for (std::uint64_t i = 0; i < seeds(400); ++i) {
      const std::array<ThreePoints, 4> points = random_planes(random, kind);
      std::vector<Plane> planes;
      for (const ThreePoints& p : points) planes.push_back(Plane::through(p[0], p[1], p[2]));
      const int expected = exact_side(points);
      EXPECT_EQ(planes[3].side_of_meeting({planes[0], planes[1], planes[2]}), expected) << kind << " " << i;
      const int twice = determinant<Twice>(points).certain_sign();
      EXPECT_TRUE(twice == 2 || twice == determinant<Expansion>(points).sign());
      // A plane's own points are on it.
      EXPECT_EQ(planes[0].side_of_meeting({planes[0], planes[1], planes[2]}), 0);
      ++asked;
      zeros += expected == 0;
      left_open += twice == 2;
    }
  EXPECT_GT(zeros, asked / 5);      // the meetings at one common point
  EXPECT_LT(left_open, asked / 2);  // few others stay undecided
}

/// All planes pass through one point, which doubles cannot locate, as the planes are nearly parallel.
TEST(PaintPlane, MeetingsAtTinyAnglesAreFoundAsNearAsDoublesAre) {
  Random random(6);
  std::size_t lost = 0;
  for (std::uint64_t i = 0; i < seeds(200); ++i) {
    const glm::dvec3 point(glm::ivec3(random.point(100)));
    std::vector<Plane> planes;
    for (int k = 0; k < 3; ++k) {
      const double up = std::ldexp(1 + random.below(1000), -38), down = std::ldexp(1 + random.below(1000), -38);
      const glm::dvec3 a(8, 0, 8 + up), b(0, 8, 8 - down);
      planes.push_back({point + double(k + 1) * a - b, Leg{a}, Leg{b}});
    }
    const std::array<Plane, 3> three{planes[0], planes[1], planes[2]};
    const Approximate quick = Plane::meeting(three), found = Plane::closest_meeting(three, 1e-9);
    EXPECT_LT(found.error, 1e-9);
    EXPECT_LE(glm::length(found.at - point), found.error);
    lost += quick.error > 1e-6;
  }
  EXPECT_GT(lost, seeds(200) / 2);
}

TEST(PaintPlane, NumbersBeyondTheirRangeAreLeftOpen) {
  for (const double size : {1e-130, 1e130}) {
    const Twice number = Twice::difference(size, 0);
    EXPECT_EQ(number.certain_sign(), 1);
    EXPECT_EQ((number * number).certain_sign(), 2);
  }
  EXPECT_EQ(Twice::difference(1, 1).certain_sign(), 2);
  EXPECT_EQ((Twice::difference(1, 3) * Twice::difference(3, 1)).certain_sign(), -1);
}

}  // namespace
}  // namespace frontmost::test
