// SPDX-License-Identifier: Apache-2.0
// Signs for lines of sight and planes against fractions; rays, weights and screen positions against each other.
#include "view/sight.h"

#include <gtest/gtest.h>

#include "frontmost/view.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/rational_vector.h"
#include "surfaces/cutouts.h"
#include "view/ray_volumes.h"
#include "view/screen_transform.h"

namespace frontmost::test {
namespace {

int sign_of(const Rational& r) { return r > 0 ? 1 : r < 0 ? -1 : 0; }

/// Points of a coarse lattice, so that many are coplanar with the eye; a few are moved by a rounding error.
glm::dvec3 lattice_point(Random& random) {
  const int x = random.below(5) - 2, y = random.below(5) - 2, z = random.below(5) - 2;
  glm::dvec3 p = glm::dvec3(x, y, z) * 0.5;
  const int axis = random.below(12);
  if (axis < 3) p[axis] += 0x1p-52;
  return p;
}

View sight_view(Random& random, bool orthographic) {
  View view;
  view.width = 64;
  view.height = 48;
  // The eye is on the lattice and looks along an axis, so the matrix is exact.
  const int x = random.below(5) - 2, y = random.below(5) - 2;
  view.world_from_eye = look_at(glm::dvec3(0.5 * x, 0.5 * y, 3), glm::dvec3(0.5 * x, 0.5 * y, 0), {0, 1, 0});
  view.projection =
      orthographic ? make_orthographic(-2, 2, -1.5, 1.5, {0.5, 9}) : make_projection(0.9, 4.0 / 3, {0.5, 9});
  return view;
}

/// 1 if a, b, c run counter-clockwise as seen.
int exact_facing(const View& view, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const RationalVector p(a), q(b), r(c);
  const RationalVector normal = cross(q - p, r - p);
  const RationalVector towards =
      view.projection.orthographic ? Rational(-1) * RationalVector(view.forward()) : RationalVector(view.eye()) - p;
  return sign_of(dot(normal, towards));
}

TEST(Sight, FacingIsExactHoweverFlatATriangleIsSeen) {
  std::array<int, 3> signs{};
  for (std::uint64_t seed = 0; seed < seeds(4000); ++seed) {
    Random random(seed);
    const View view = sight_view(random, seed % 2 == 0);
    const Sight sight(view);
    const glm::dvec3 a = lattice_point(random), b = lattice_point(random), c = lattice_point(random);
    const int expected = exact_facing(view, a, b, c);
    ASSERT_EQ(sight.facing(a, b, c), expected) << seed;
    ASSERT_EQ(sight.facing(b, c, a), expected) << seed;
    ASSERT_EQ(sight.facing(b, a, c), -expected) << seed << ": the other way round";
    ++signs[std::size_t(expected + 1)];
  }
  for (const int count : signs) EXPECT_GE(count, int(seeds(150)));
}

// With slack, a sign stays open if the point may lie on either side, and is certain otherwise.
TEST(Sight, SlackLeavesSignsOpenOnlyNearThePlane) {
  Random random(5);
  const View view = sight_view(random, false);
  const Sight sight(view);
  const Sight::EyePlane plane = sight.plane_through({-1, 0, 0}, {1, 0.25, 0});
  for (const double above : {1e-3, 1e-6, 1e-9}) {
    const glm::dvec3 x(0, 0.125 + above, 0);
    EXPECT_EQ(plane.turn(x).sign, 1);
    EXPECT_EQ(plane.turn(x, above * 0.1).sign, 1) << above;
    EXPECT_EQ(plane.turn(x, above * 10).sign, 0) << above;
    EXPECT_EQ(plane.turn(glm::dvec3(0, 0.125 - above, 0), above * 0.1).sign, -1) << above;
  }
  EXPECT_EQ(plane.turn({0, 0.125, 0}).sign, 0) << "on the line from p to q";
}

TEST(FacePlane, HeightsAreExact) {
  std::array<int, 3> signs{};
  for (std::uint64_t seed = 0; seed < seeds(3000); ++seed) {
    Random random(seed + 7000);
    const glm::dvec3 a = lattice_point(random), b = lattice_point(random), c = lattice_point(random);
    const glm::dvec3 x = lattice_point(random);
    const RationalVector p(a);
    const int expected = sign_of(dot(cross(RationalVector(b) - p, RationalVector(c) - p), RationalVector(x) - p));
    ASSERT_EQ(FacePlane(a, b, c).height(x).sign, expected) << seed;
    ASSERT_EQ(FacePlane(c, a, b).height(x).sign, expected) << seed;
    ASSERT_EQ(FacePlane(a, c, b).height(x).sign, -expected) << seed;
    ASSERT_EQ(FacePlane(a, b, c).height(b).sign, 0) << seed << ": a corner lies in the plane";
    ++signs[std::size_t(expected + 1)];
  }
  for (const int count : signs) EXPECT_GE(count, int(seeds(150)));
}

// A ray through (x, y) leads to points that Sight maps to (x, y): both use the same view, in opposite directions.
TEST(ScreenRays, LeadToThePlacesThatSightSees) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const View view = random_view(random, 1 + random.below(300), 1 + random.below(200));
    const ScreenRays rays(view);
    const Sight sight(view);
    EXPECT_EQ(rays.is_parallel(), sight.is_parallel());
    for (int i = 0; i < 20; ++i) {
      const double x = double(random.within(-1, 2)) * view.width, y = double(random.within(-1, 2)) * view.height;
      const double depth = double(random.within(0.5f, 6));
      const glm::dvec3 world = view.eye() + rays.point(x, y, depth);
      const glm::dvec3 screen = sight.to_screen(sight.in_eye(world));
      ASSERT_NEAR(screen.x, x, 1e-9 * (1 + view.width));
      ASSERT_NEAR(screen.y, y, 1e-9 * (1 + view.height));
      ASSERT_NEAR(screen.z, depth, 1e-12);
    }
  }
}

// Vertices are snapped from floats: within half a step of 1/256 pixel, plus the rounding of floats.
TEST(ScreenTransform, SnapsToTheUnitThatSightSees) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const View view = random_view(random, 100 + random.below(900), 100 + random.below(900));
    const ScreenTransform transform(view);
    const Sight sight(view);
    for (int i = 0; i < 50; ++i) {
      const glm::vec3 world = random.point(1);
      const HomogeneousVertex vertex = frontmost::transform(transform, world);
      if (!is_plain(transform, vertex)) continue;
      const ScreenVertex snapped = snap(transform, vertex);
      const glm::dvec3 screen = sight.to_screen(sight.in_eye(glm::dvec3(world)));
      ASSERT_NEAR((snapped.x + transform.centre_x) / 256.0, screen.x, 0.5 / 256 + 2e-3) << seed;
      ASSERT_NEAR((snapped.y + transform.centre_y) / 256.0, screen.y, 0.5 / 256 + 2e-3) << seed;
      ASSERT_NEAR(depth_of_key(view, snapped.key), screen.z, 1e-5 * (1 + screen.z * screen.z)) << seed;
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000u);
}

TEST(RayVolumes, AreProportionalToBarycentricWeights) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const View view = sight_view(random, seed % 2 == 0);
    const ScreenRays rays(view);
    const Sight sight(view);
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& corner : corners) corner = glm::dvec3(random.point(1)) - view.eye();
    const double u = double(random.unit()), v = double(random.unit()) * (1 - u);
    const glm::dvec3 weights(1 - u - v, u, v);
    const glm::dvec3 point = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
    const glm::dvec3 screen = sight.to_screen(sight.in_eye(view.eye() + point));
    const RayVolumes volumes = ray_volumes(rays, corners, screen.x, screen.y);
    const double sum = volumes.value.x + volumes.value.y + volumes.value.z;
    if (std::abs(sum) < 1e-3) continue;  // seen edge-on
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(volumes.value[k] / sum, weights[k], 1e-9) << seed;
    // The volumes are affine over the screen: other pixels are reached by steps.
    const RayVolumes corner = ray_volumes(rays, corners, 0, 0);
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(corner.value[k] + screen.x * corner.step_x[k] + screen.y * corner.step_y[k], volumes.value[k], 1e-9);
  }
}

TEST(NormalizedWeights, AddUpToOneWhateverTheyAreMadeOf) {
  EXPECT_EQ(normalized_weights({1, 1, 2}), glm::vec3(0.25f, 0.25f, 0.5f));
  EXPECT_EQ(normalized_weights({-1, -1, -2}), glm::vec3(0.25f, 0.25f, 0.5f)) << "the common factor may be negative";
  EXPECT_EQ(normalized_weights({0, 3, 0}), glm::vec3(0, 1, 0));
  const double infinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 odd[] = {{0, 0, 0}, {infinity, 1, 1}, {std::nan(""), 1, 1}, {1e-320, 0, 0}, {1, -1, 0}, {-3, 1, 1}};
  for (const glm::dvec3& values : odd) {
    const glm::vec3 weights = normalized_weights(values);
    EXPECT_NEAR(weights.x + weights.y + weights.z, 1, 1e-6) << values.x;
    for (int k = 0; k < 3; ++k) EXPECT_GE(weights[k], 0) << values.x;
  }
}

}  // namespace
}  // namespace frontmost::test
