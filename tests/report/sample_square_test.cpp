// SPDX-License-Identifier: Apache-2.0
// The square around a sample against rational arithmetic, which cuts and intersects in another way.
#include "report/sample_square.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/effort.h"
#include "support/random_scene.h"
#include "support/rational_vector.h"

namespace frontmost::test {
namespace {

using Polygon = std::vector<RationalVector>;

/// The part of a polygon where normal.(p - point) >= 0.
Polygon cut(const Polygon& polygon, const RationalVector& point, const RationalVector& normal) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalVector &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Rational at_a = dot(normal, a - point), at_b = dot(normal, b - point);
    if (at_a >= 0) result.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0))
      result.push_back(a + Rational(at_a / (at_a - at_b)) * (b - a));
  }
  return result;
}

Polygon polygon_of(const std::array<glm::vec3, 3>& corners) {
  Polygon result;
  for (const glm::vec3& corner : corners) result.emplace_back(glm::dvec3(corner));
  return result;
}

/// The part of the triangle beyond the near plane, within the pyramid or prism of the square.
Polygon within(const std::array<glm::vec3, 3>& corners, const SampleSquare& square, const SampleRays& rays) {
  const RationalVector near{rays.eye() + rays.near() * rays.forward()}, forward{rays.forward()};
  Polygon polygon = cut(polygon_of(corners), near, forward);
  for (std::size_t i = 0; i < 4; ++i) {
    const SampleRay &a = square.corners[i], &b = square.corners[(i + 1) % 4], &c = square.corners[(i + 2) % 4];
    const RationalVector origin(a.origin);
    const RationalVector along = RationalVector(b.origin) + RationalVector(b.direction) - origin;
    RationalVector normal = cross(RationalVector(a.direction), along);
    if (dot(normal, RationalVector(c.origin) + RationalVector(c.direction) - origin) < 0)
      normal = Rational(-1) * normal;
    polygon = cut(polygon, origin, normal);
  }
  return polygon;
}

/// Distance at which a ray hits a triangle strictly inside its edges; negative if it misses.
Rational hit(const std::array<glm::vec3, 3>& corners, const SampleRay& ray) {
  const RationalVector a{glm::dvec3(corners[0])}, v{ray.direction};
  const RationalVector p = RationalVector(glm::dvec3(corners[1])) - a, q = RationalVector(glm::dvec3(corners[2])) - a;
  const RationalVector from = RationalVector(ray.origin) - a, h = cross(v, q);
  const Rational determinant = dot(p, h);  // T. Moeller, B. Trumbore, 1997
  if (determinant == 0) return -1;
  const Rational u = dot(from, h) / determinant, w = dot(v, cross(from, p)) / determinant;
  if (u <= 0 || w <= 0 || u + w >= 1) return -1;
  return dot(q, cross(from, p)) / determinant;
}

constexpr double kNear = 0.01, kFar = 1e9;

/// True for triangles between the near and far planes.
bool is_between_planes(const std::array<glm::vec3, 3>& corners, const SampleRays& rays) {
  return std::all_of(corners.begin(), corners.end(), [&](const glm::vec3& corner) {
    const double depth = glm::dot(rays.forward(), glm::dvec3(corner) - rays.eye());
    return depth > 1.1 * kNear && depth < 0.9 * kFar;
  });
}

/// The square around a random point of a triangle, within a few 1/256 pixel; anywhere if the triangle is behind the eye
/// or beside the picture.
SampleSquare square_on(const std::array<glm::vec3, 3>& corners, const View& view, const SampleRays& rays,
                       Random& random) {
  const float to_third = random.unit(), to_second = random.unit();
  const glm::vec3 at = glm::mix(glm::mix(corners[0], corners[1], to_second), corners[2], to_third);
  const glm::dvec3 eye(glm::inverse(view.world_from_eye) * glm::dvec4(at, 1));
  const Projection& p = view.projection;
  const double scale = p.orthographic ? 1 : -1 / eye.z;
  const glm::dvec2 place((eye.x * scale - p.left) / (p.right - p.left) * view.width,
                         (p.top - eye.y * scale) / (p.top - p.bottom) * view.height);
  if (!(place.x > 0 && place.y > 0 && place.x < view.width && place.y < view.height)) {
    const int y = random.below(view.height), x = random.below(view.width);
    return SampleSquare(rays, glm::ivec2(x, y) * 256 + 128);
  }
  const int dy = random.below(9) - 4, dx = random.below(9) - 4;
  return SampleSquare(rays, glm::ivec2(place * 256.0) + glm::ivec2(dx, dy));
}

class SquareOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(SampleSquare, SquareOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(SquareOfEveryKind, MeetsAndContainsAsRationalArithmeticSays) {
  std::size_t missed = 0, contained = 0, touched = 0;
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    Random random(seed + 70);
    const Scene scene = scene_of(random_mesh(GetParam(), 12, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 40, 30);
    view.projection.clip = {kNear, kFar};
    const SampleRays rays(view);
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const auto corners = surfaces.corners(id);
      const ViewedTriangle triangle(corners, rays);
      for (int i = 0; i < 12; ++i) {
        const SampleSquare square = square_on(corners, view, rays, random);
        const LineMeeting meeting = triangle.meeting(square);
        const bool meets = !within(corners, square, rays).empty();
        const bool contains = std::all_of(square.corners.begin(), square.corners.end(),
                                          [&](const SampleRay& ray) { return hit(corners, ray) > 0; });
        if (!is_between_planes(corners, rays)) {
          ASSERT_TRUE(meeting != LineMeeting::contains || contains) << "seed " << seed << " triangle " << id;
          ASSERT_TRUE(meeting != LineMeeting::misses || !meets) << "seed " << seed << " triangle " << id;
          continue;
        }
        ASSERT_EQ(meeting != LineMeeting::misses, meets) << "seed " << seed << " triangle " << id;
        ASSERT_EQ(meeting == LineMeeting::contains, contains) << "seed " << seed << " triangle " << id;
        missed += !meets;
        contained += contains;
        touched += meets && !contains;
      }
    }
  }
  // One seed need not have all cases, nor triangles that reach behind the eye.
  if (tries_little || GetParam() == Kind::huge || GetParam() == Kind::through_eye) return;
  EXPECT_GT(missed, 0u);
  EXPECT_GT(contained, GetParam() == Kind::slivers ? 0u : seeds(6));
  EXPECT_GT(touched, 0u);
}

TEST_P(SquareOfEveryKind, KnowsHowNearThePlaneIs) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    Random random(seed + 170);
    const Scene scene = scene_of(random_mesh(GetParam(), 30, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 40, 30);
    view.projection.clip = {kNear, kFar};
    const SampleRays rays(view);
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const auto corners = surfaces.corners(id);
      const SampleSquare square = square_on(corners, view, rays, random);
      const ViewedTriangle triangle(corners, rays);
      if (triangle.meeting(square) != LineMeeting::contains) continue;
      const NearnessRange range = triangle.nearness(square);
      Rational least, most;
      for (std::size_t i = 0; i < 4; ++i) {
        const Rational depth = hit(corners, square.corners[i]);
        const Rational nearness = rays.is_orthographic() ? Rational(-depth) : Rational(1 / depth);
        if (i == 0 || nearness < least) least = nearness;
        if (i == 0 || nearness > most) most = nearness;
      }
      ASSERT_LE(Rational(range.least.low), least);
      ASSERT_GE(Rational(range.least.high), least);
      ASSERT_LE(Rational(range.greatest.low), most);
      ASSERT_GE(Rational(range.greatest.high), most);
      ASSERT_LT(range.least.high - range.least.low, 1e-9 * (1 + std::abs(range.least.high)));
      ++compared;
    }
  }
  EXPECT_GE(compared, GetParam() == Kind::slivers ? 0u : seeds(6));
}

std::array<glm::vec3, 3> sheet(float distance) {
  return {glm::vec3(-4, -4, -distance), glm::vec3(4, -4, -distance), glm::vec3(0, 4, -distance)};
}

// Two sheets that face the eye have keys near / distance. They are told apart if their keys differ by more than the
// rounding errors of keys and of the vertices' depths; here, to the last bit of the farther sheet's place.
TEST(SampleSquare, TellsSheetsApartFromTheExactResolutionOn) {
  for (const bool orthographic : {false, true}) {
    View view;
    view.width = view.height = 64;
    view.projection = orthographic ? make_orthographic(-1, 1, -1, 1, {0.5, 4.5}) : make_projection(1, 1, {0.5, 4.5});
    const SampleRays rays(view);
    const SampleSquare square(rays, glm::ivec2(31, 32) * 256 + 128);
    const ViewedTriangle front(sheet(2), rays);
    int first_apart = 0;
    for (int steps = 1; steps < 64 && first_apart == 0; ++steps) {
      const ViewedTriangle back(sheet(2 + float(steps) * 0x1p-22f), rays);
      ASSERT_FALSE(is_surely_nearer(back, front, square));
      if (is_surely_nearer(front, back, square)) first_apart = steps;
    }
    // The vertices are 6 from the eye, 3 times their depth. Perspective: 20 + 6 * 3 roundings of 2^-24, so the gap
    // exceeds 2 * 38 * 2^-24, 19 steps of 2^-22. Parallel: 20 roundings of the 4 between the planes, 20 steps, and 6 of
    // the distance of 6, 9 steps.
    EXPECT_EQ(first_apart, orthographic ? 30 : 20);
  }
}

TEST(SampleSquare, TheNearPlaneIsARim) {
  View view;
  view.width = view.height = 64;
  view.projection = make_projection(1, 1, {2, 50});
  const SampleRays rays(view);
  const SampleSquare square(rays, glm::ivec2(31, 32) * 256 + 128);
  EXPECT_EQ(ViewedTriangle(sheet(1.99f), rays).meeting(square), LineMeeting::misses);
  EXPECT_EQ(ViewedTriangle(sheet(2), rays).meeting(square), LineMeeting::touches);
  EXPECT_EQ(ViewedTriangle(sheet(2.01f), rays).meeting(square), LineMeeting::contains);
  EXPECT_EQ(ViewedTriangle(sheet(49.9f), rays).meeting(square), LineMeeting::contains);
  EXPECT_EQ(ViewedTriangle(sheet(50.1f), rays).meeting(square), LineMeeting::misses);
}

}  // namespace
}  // namespace frontmost::test
