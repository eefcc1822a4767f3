// SPDX-License-Identifier: Apache-2.0
// The gap promised between two surfaces by formats, positions and transforms together, against pictures of such
// surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "support/odd_numbers.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

double uniform(Random& random, double low, double high) { return low + (high - low) * double(random.unit()); }

glm::dvec3 direction_of(Random& random) {
  glm::dvec3 v(0);
  do v = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
  while (!(glm::length(v) > 0.1 && glm::length(v) < 1));
  return glm::normalize(v);
}

/// A random camera and depth buffer.
struct Try {
  View view;
  DepthSetup setup;
  double distance = 0;
};

Try random_try(Random& random) {
  Try one;
  const double near = std::exp(uniform(random, -5, 5));
  const double far = random.below(3) ? near * std::exp(uniform(random, 0.01, 7)) : kInfinity;
  one.setup = {{near, far}, DepthFormat(random.below(4)), random.below(2) == 1, random.below(4) == 0};
  if (one.setup.orthographic && !std::isfinite(far)) one.setup.clip.far = near * 100;
  const double last = std::min(one.setup.clip.far, near * 1000);
  one.distance = near * std::exp(uniform(random, 0.0, 1.0) * std::log(last / near));
  one.distance = std::clamp(one.distance, near, one.setup.clip.far);
  one.view.width = one.view.height = 24;
  const glm::dvec3 eye = direction_of(random) * uniform(random, 0, 0.5) * one.distance;
  one.view.world_from_eye = look_at(eye, eye + direction_of(random) * one.distance, direction_of(random));
  // Vertices are at most 1.5 times the distance away, which leaves half of it for the eye's position.
  const double side = one.distance * uniform(random, 0.1, 0.7);
  one.view.projection = one.setup.orthographic ? make_orthographic(-side, side, -side, side, one.setup.clip)
                                               : make_frustum(-0.7, 0.7, -0.7, 0.7, one.setup.clip);
  if (!one.setup.orthographic) {
    const double tangent = side / one.distance;
    one.view.projection.left = one.view.projection.bottom = -tangent;
    one.view.projection.right = one.view.projection.top = tangent;
  }
  return one;
}

/// A quadrilateral that fills the picture, facing the eye, in floats.
Mesh facing(const Try& one, double distance, Random& random) {
  Mesh mesh;
  for (const glm::dvec2& corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    const double reach = one.view.projection.right * (one.setup.orthographic ? 1 : distance);
    const glm::dvec2 xy = corner * reach * uniform(random, 1.0, 1.05);
    mesh.positions.emplace_back(glm::dvec3(one.view.world_from_eye * glm::dvec4(xy, -distance, 1)));
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Pixels that show the farther of two surfaces, although only the nearer should be seen.
std::size_t wrong_pixels(const Try& one, double gap, Random& random) {
  Scene scene;
  const bool nearer_first = random.below(2) == 1;
  for (const bool is_nearer : {nearer_first, !nearer_first}) {
    scene.meshes.push_back(facing(one, one.distance + (is_nearer ? 0 : gap), random));
    scene.instances.push_back({is_nearer ? "nearer" : "farther", std::uint32_t(scene.instances.size())});
  }
  const Execution alone{.threads = 1};
  const Surfaces surfaces(scene, alone);
  DepthBuffer buffer(one.view.width, one.view.height, 1, one.setup.format);
  DepthDraw call;
  if (one.setup.reversed) {
    call.state.nearer_is_greater = true;
    call.state.func = DepthFunc::greater;
    buffer.clear(0);
  }
  buffer.draw(surfaces, one.view, call, alone);
  std::size_t wrong = 0;
  for (const PrimitiveId id : buffer.visible(one.view).primitives)
    wrong += id != no_primitive && scene.instances[surfaces.source(id).instance].name == "farther";
  return wrong;
}

struct Tally {
  std::size_t tried = 0, wrong_scenes = 0, wrong_pixels = 0;
};

/// Counts wrong pixels in random scenes whose surfaces are `share` of the promised gap apart.
Tally tally_of(double share, std::size_t scenes) {
  Random random(11);
  Tally tally;
  for (std::size_t i = 0; i < scenes; ++i) {
    const Try one = random_try(random);
    const double gap = certain_gap(one.setup, one.distance) * share;
    if (!(one.distance + gap < one.setup.clip.far * 0.9999)) continue;
    // Vertices of the nearer surface may be rounded to before the near plane, where nothing is drawn.
    if (one.distance < one.setup.clip.near * 1.0001) continue;
    const std::size_t wrong = wrong_pixels(one, gap, random);
    ++tally.tried;
    tally.wrong_scenes += wrong > 0;
    tally.wrong_pixels += wrong;
  }
  return tally;
}

TEST(CertainGap, IsSeenAtEveryPixel) {
  const Tally tally = tally_of(1, 6000);
  EXPECT_GT(tally.tried, 3000u);
  EXPECT_EQ(tally.wrong_pixels, 0u);
}

TEST(CertainGap, IsNotPromisedForATenth) {
  const Tally tally = tally_of(0.1, 1000);
  EXPECT_GT(tally.wrong_scenes, tally.tried / 4) << "of " << tally.tried;
}

// Between 100 and 101 a step of 24 bits is 6e-8, but floats there are 7.6e-6 apart.
TEST(CertainGap, IsThatOfFloatsWhereTheFormatIsFiner) {
  const DepthSetup setup{{100, 101}, DepthFormat::d24};
  EXPECT_NEAR(resolvable_gap(setup, 100.5), 6e-8, 1e-9);
  const double gap = certain_gap(setup, 100.5);
  EXPECT_NEAR(gap, 40 * std::ldexp(100.5, -24), 0.01 * gap);
  EXPECT_NEAR(rounding_gap(setup, 100.5, 201), rounding_gap(setup, 100.5), 1e-18);
  EXPECT_LT(rounding_gap(setup, 100.5, 101), rounding_gap(setup, 100.5));
  EXPECT_GT(certain_gap(setup, 100.5, 1000), gap);
}

TEST(CertainGap, IsThatOfTheFormatWhereFloatsAreFiner) {
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16}) {
    const DepthSetup setup{{0.1, 1000}, format};
    EXPECT_NEAR(certain_gap(setup, 1) / resolvable_gap(setup, 1), 1, 0.02);
  }
  EXPECT_EQ(certain_gap({{0.1, kInfinity}, DepthFormat::d8}, 1000), kInfinity);
}

TEST(CertainGap, InParallelProjectionCountsFromThePlanes) {
  const DepthSetup setup{{-5, 5}, DepthFormat::d24, false, true};
  EXPECT_GT(certain_gap(setup, 0), resolvable_gap(setup, 0));
  EXPECT_NEAR(rounding_gap(setup, 5), 2 * 90 * std::ldexp(1.0, -24), 1e-15);
  EXPECT_THROW((void)rounding_gap(setup, 6), Error);
  EXPECT_THROW((void)certain_gap(setup, 6), Error);
}

}  // namespace
}  // namespace frontmost::test
