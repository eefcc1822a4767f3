// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shade/geometry/geometry.h"
#include "support/interpolation.h"
#include "support/odd_numbers.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

using test::kNan;

/// A view of 200 x 100 pixels from the origin along -z; one unit at distance 1 spans 50 pixels.
View view_at_origin() {
  View view;
  view.width = 200;
  view.height = 100;
  view.projection = make_frustum(-2, 2, -1, 1, {1, 100});
  return view;
}

glm::vec2 screen_of(const glm::vec3& p) { return {100 + 50 * p.x / -p.z, 50 - 50 * p.y / -p.z}; }

TriangleSetup set_up(const View& view, const std::array<glm::vec3, 3>& corners, const glm::vec2& reference) {
  TriangleSetup setup;
  set_up_plane(setup, ScreenRays(view), corners, reference);
  return setup;
}

// The worked example of the literature: a segment from (-4, 2) to (2, 5) in (x, distance), seen from the origin. Half
// way across the picture plane, the distance is not the mean of the ends.
TEST(TriangleSetup, DepthOfTheWorkedExampleIsInterpolatedByItsReciprocal) {
  const std::array<glm::vec3, 3> corners{{{-4, 0, -2}, {2, 0, -5}, {2, 1, -5}}};
  const View view = view_at_origin();
  // The segment's point at distance 4: t = 2/3, x = 0.
  const glm::vec2 p = screen_of({0, 0, -4});
  const TriangleSetup setup = set_up(view, corners, p);
  const Barycentric b = barycentric(setup, p.x, p.y);
  EXPECT_NEAR(-interpolate(setup.corner, b.weight).z, 4.0f, 1e-5f);
  EXPECT_NEAR(b.weight.x, 1.0f / 3, 1e-6f);
  // On the screen p is 5/6 of the way from the first end (x = 0) to the other (x = 120): linear gives 4.5.
  const float t = (p.x - screen_of(corners[0]).x) / (screen_of(corners[1]).x - screen_of(corners[0]).x);
  EXPECT_NEAR(2 + t * 3, 4.5f, 1e-5f);
}

TEST(TriangleSetup, WeightsFindPointsOfTheTriangleAgain) {
  std::mt19937 random(test::noted_seed(7));
  std::uniform_real_distribution<float> across(-3, 3), away(-9, -1.5f), part(0, 1);
  for (const bool parallel : {false, true}) {
    View view = view_at_origin();
    if (parallel) view.projection = make_orthographic(-4, 4, -2, 2, {1, 100});
    for (int round = 0; round < 2000; ++round) {
      std::array<glm::vec3, 3> corners;
      for (glm::vec3& c : corners) c = {across(random), across(random), away(random)};
      const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      if (std::abs(glm::dot(glm::normalize(normal), glm::normalize(parallel ? glm::vec3(0, 0, 1) : corners[0]))) <
          0.05f)
        continue;  // nearly edge-on: the question is ill-conditioned
      float a = part(random), c = part(random);
      if (a + c > 1) a = 1 - a, c = 1 - c;
      const glm::vec3 weight(1 - a - c, a, c);
      const glm::vec3 point = interpolate(corners, weight);
      const glm::vec2 screen = parallel ? glm::vec2(100 + 25 * point.x, 50 - 25 * point.y) : screen_of(point);
      const TriangleSetup setup = set_up(view, corners, screen + glm::vec2(0.25f, 0));
      const Barycentric b = barycentric(setup, screen.x, screen.y);
      ASSERT_LT(glm::length(b.weight - weight), 2e-3f) << "round " << round << " parallel " << parallel;
    }
  }
}

TEST(TriangleSetup, NothingExtrapolatesPastAnEdge) {
  const std::array<glm::vec3, 3> corners{{{-1, -1, -3}, {1, -1, -3}, {0, 1, -3}}};
  const TriangleSetup setup = set_up(view_at_origin(), corners, {100, 50});
  for (const glm::vec2 outside : {glm::vec2(0, 0), glm::vec2(199, 99), glm::vec2(100, 20), glm::vec2(60, 66)}) {
    const Barycentric b = barycentric(setup, outside.x, outside.y);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(b.weight[k], 0.0f);
      EXPECT_LE(b.weight[k], 1.0f);
    }
    EXPECT_NEAR(b.weight.x + b.weight.y + b.weight.z, 1.0f, 1e-6f);
  }
}

TEST(TriangleSetup, AGroundPlaneFromBehindTheEyeToTheHorizonIsExact) {
  const std::array<glm::vec3, 3> corners{{{-1e4f, -1, 1e4f}, {1e4f, -1, 1e4f}, {0, -1, -1e5f}}};
  for (const float y : {51.0f, 60.0f, 99.0f}) {
    const TriangleSetup setup = set_up(view_at_origin(), corners, {100, y});
    const glm::vec3 point = interpolate(setup.corner, barycentric(setup, 100, y).weight);
    EXPECT_NEAR(-point.z * (y - 50) / 50, 1.0f, 2e-3f) << "row " << y;
    EXPECT_NEAR(point.x, 0.0f, 0.05f);
    EXPECT_GT(setup.plane_normal.y, 0.999f);
  }
}

TEST(TriangleSetup, NormalsFaceTheViewerAndTheWindingIsKnown) {
  const std::array<glm::vec3, 3> front{{{-1, -1, -3}, {1, -1, -3}, {0, 1, -3}}};
  const std::array<glm::vec3, 3> back{{front[0], front[2], front[1]}};
  EXPECT_EQ(set_up(view_at_origin(), front, {100, 50}).plane_normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(set_up(view_at_origin(), back, {100, 50}).plane_normal, glm::vec3(0, 0, 1));
  EXPECT_FALSE(set_up(view_at_origin(), front, {100, 50}).is_backside);
  EXPECT_TRUE(set_up(view_at_origin(), back, {100, 50}).is_backside);
}

TEST(TriangleSetup, DegenerateAndEdgeOnTrianglesGiveTheirMiddle) {
  const glm::vec3 p(0, 0, -3);
  for (const auto& corners : {std::array<glm::vec3, 3>{{p, p, p}},
                              {{p, {1, 0, -3}, {2, 0, -3}}},
                              {{{0, 0, -1}, {0, 0, -2}, {0, 0, -3}}},
                              {{{0, 0, 0}, {1, 0, -1}, {1, 1, -1}}},
                              {{{kNan, 0, -1}, {0, 1, -2}, {0, 0, -3}}}}) {
    const TriangleSetup setup = set_up(view_at_origin(), corners, {100, 50});
    for (const float x : {0.0f, 100.0f, 1e9f, kNan}) {
      const Barycentric b = barycentric(setup, x, 50);
      EXPECT_NEAR(b.weight.x + b.weight.y + b.weight.z, 1.0f, 1e-5f);
      EXPECT_TRUE(std::isfinite(b.divisor));
    }
  }
}

// u and v along a quad that extends far away: the gradient must be the derivative of the perspective map, not its
// chord.
TEST(TriangleSetup, TextureGradientsAreTheDerivativesOfThePerspectiveMap) {
  const std::array<glm::vec3, 3> corners{{{-2, -1, -1.5f}, {2, -1, -1.5f}, {2, -1, -30}}};
  const std::array<glm::vec2, 3> texcoord{{{0, 0}, {4, 0}, {4, 28.5f}}};  // u = x + 2, v = distance - 1.5
  for (const float y : {54.0f, 60.0f, 75.0f}) {
    const float distance = 50 / (y - 50), x = 102;
    const TriangleSetup setup = set_up(view_at_origin(), corners, {x, y});
    const Barycentric b = barycentric(setup, x, y);
    const glm::vec2 uv = interpolate(texcoord, b.weight);
    EXPECT_NEAR(uv.x, 2 + (x - 100) / 50 * distance, 1e-3f);
    EXPECT_NEAR(uv.y, distance - 1.5f, 1e-3f);
    const Gradient change = gradient(setup, texcoord, uv, b);
    EXPECT_NEAR(change.dx.x, distance / 50, 1e-4f);
    EXPECT_NEAR(change.dx.y, 0.0f, 1e-3f);
    EXPECT_NEAR(change.dy.y, -50 / ((y - 50) * (y - 50)), 2e-3f);
    EXPECT_NEAR(change.dy.x, -(x - 100) / ((y - 50) * (y - 50)), 1e-3f);
  }
}

}  // namespace
}  // namespace frontmost::shading
