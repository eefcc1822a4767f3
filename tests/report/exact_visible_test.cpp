// SPDX-License-Identifier: Apache-2.0
// The exact answer against rational arithmetic, and errors of depth buffers against it.
#include <gtest/gtest.h>

#include <numeric>

#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "report/exact_depth.h"
#include "support/costly_meshes.h"
#include "support/effort.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include "support/rational_vector.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

Rational rational_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays, const SampleRay& ray) {
  const RationalVector a(corners[0]), b(corners[1]), c(corners[2]), forward(rays.forward()), eye(rays.eye());
  Rational low = dot(forward, a - eye), high = low;
  for (const RationalVector& corner : {b, c}) {
    const Rational depth = dot(forward, corner - eye);
    if (depth < low) low = depth;
    if (depth > high) high = depth;
  }
  const RationalVector normal = cross(b - a, c - a);
  const Rational below = dot(normal, RationalVector(ray.direction));
  Rational depth = below == 0 ? low : Rational(dot(normal, a - RationalVector(ray.origin)) / below);
  const Rational limits[] = {low, high, Rational(rays.near()), Rational(rays.far())};
  if (depth < limits[0]) depth = limits[0];
  if (depth > limits[1]) depth = limits[1];
  if (depth < limits[2]) depth = limits[2];
  if (depth > limits[3]) depth = limits[3];
  return depth;
}

/// Triangles that cover a sample, by the oracle's coverage alone.
std::vector<std::vector<PrimitiveId>> covering(const Surfaces& surfaces, const View& view) {
  std::vector<std::vector<PrimitiveId>> lists(view.sample_count());
  const ScreenTransform transform(view);
  const Visible planes = nothing_visible(view);
  for_each_primitive(surfaces, 0, no_primitive, [&](PrimitiveId id, const std::array<glm::vec3, 3>& world) {
    for_each_triangle(transform, view.culling, clip_triangle(transform, world), id, [&](const OracleTriangle& t) {
      for_each_covered(planes, t, [&](std::size_t at, float) { lists[at].push_back(id); });
    });
  });
  return lists;
}

class ExactOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(ExactVisible, ExactOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(ExactOfEveryKind, EqualsRationalArithmetic) {
  std::size_t contested = 0, tied = 0;
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 40);
    const Scene scene = scene_of(random_mesh(GetParam(), 40, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 40, 30);
    view.samples = seed == 5 ? 2 : 1;
    const auto lists = covering(surfaces, view);
    const ExactVisible answer = find_exact_visible(surfaces, view);
    const SampleRays rays(view);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const int pixel = int(i % view.pixel_count());
      const SampleRay ray = rays.at(glm::ivec2(pixel % view.width, pixel / view.width) * 256 +
                                    sample_offsets(view.samples)[i / view.pixel_count()]);
      PrimitiveId best = no_primitive;
      Rational nearest;
      bool is_tied = false;
      for (const PrimitiveId id : lists[i]) {
        const Rational depth = rational_depth(surfaces.corners(id), rays, ray);
        if (best != no_primitive && depth == nearest) is_tied = true;
        if (best != no_primitive && depth >= nearest) continue;
        best = id;
        nearest = depth;
        is_tied = false;
      }
      contested += lists[i].size() > 1;
      tied += is_tied;
      ASSERT_EQ(answer.primitives[i], best) << "sample " << i;
      ASSERT_EQ(answer.tied[i] != 0, is_tied) << "sample " << i;
    }
  }
  const bool covers_little = GetParam() == Kind::tiny || GetParam() == Kind::slivers;
  EXPECT_GE(contested, covers_little ? 0u : seeds(6) * 3) << "nothing lies before anything";
  EXPECT_EQ(tied > seeds(6) * 80, GetParam() == Kind::coplanar);
}

TEST(Expansion, EqualsRationalArithmetic) {
  Random random(5);
  const auto number = [&] { return std::ldexp(double(random.unit()) - 0.5, random.below(60) - 30); };
  for (int i = 0; i < 3000; ++i) {
    const double a = number(), b = number(), c = random.below(5) ? number() : a, d = random.below(5) ? number() : b;
    const Expansion value = Expansion::difference(a, b) * Expansion::difference(c, d) -
                            (Expansion(a) * Expansion(c) + Expansion(b) * Expansion(d)) +
                            (Expansion(a) * Expansion(d) + Expansion(b) * Expansion(c));
    EXPECT_EQ(value.sign(), 0);
    const Rational exact = Rational(a) * Rational(b) * Rational(c) - Rational(d);
    EXPECT_EQ((Expansion(a) * Expansion(b) * Expansion(c) - Expansion(d)).sign(), exact < 0 ? -1 : exact > 0 ? 1 : 0);
  }
}

/// Adds a square at a distance from the eye, which is at the origin and looks along -z.
void add_square(Mesh& mesh, float distance) {
  const float s = distance;
  add_triangle(mesh, {-s, -s, -distance}, {s, -s, -distance}, {s, s, -distance});
  add_triangle(mesh, {-s, -s, -distance}, {s, s, -distance}, {-s, s, -distance});
}

View square_view(double near, double far) {
  View view;
  view.width = view.height = 64;
  view.projection = make_projection(1.0, 1.0, {near, far});
  return view;
}

Scene two_squares(float first, float second) {
  Scene scene;
  for (const float distance : {first, second}) {
    Mesh mesh;
    add_square(mesh, distance);
    scene.meshes.push_back(mesh);
    scene.instances.push_back({"square", std::uint32_t(scene.meshes.size() - 1), glm::dmat4(1.0)});
  }
  return scene;
}

DepthFights fights_with(const Surfaces& surfaces, const View& view, DepthFormat format, bool reversed = false) {
  DepthBuffer buffer(view.width, view.height, view.samples, format);
  buffer.clear(reversed ? 0 : 1);
  DepthDraw call;
  call.state.func = reversed ? DepthFunc::greater : DepthFunc::less;
  call.state.nearer_is_greater = reversed;
  buffer.draw(surfaces, view, call);
  return find_depth_fights(surfaces, find_exact_visible(surfaces, view), buffer.visible(view));
}

// The picture resolves the gap that resolvable_gap() promises; with a tenth of the gap, it is all wrong.
TEST(DepthFights, SquaresFightWhereTheFormatCannotTellThemApart) {
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24}) {
    const float distance = 40;
    const double near = format == DepthFormat::d24 ? 0.01 : 1, far = 1000;
    const auto gap = float(resolvable_gap({{near, far}, format}, 40));
    const View view = square_view(near, far);
    // The farther square is drawn first, so only a resolved difference brings the nearer one to the front.
    const Scene apart = two_squares(distance + gap * 1.01f, distance);
    EXPECT_EQ(fights_with(Surfaces(apart), view, format).wrong, 0u);
    const Scene close = two_squares(distance + gap * 0.02f, distance);
    const Surfaces surfaces(close);
    const DepthFights fights = fights_with(surfaces, view, format);
    EXPECT_EQ(fights.covered, view.pixel_count());
    EXPECT_EQ(fights.tied, 0u);
    ASSERT_EQ(fights.wrong, view.pixel_count());
    ASSERT_EQ(fights.pairs.size(), 1u);
    EXPECT_EQ(fights.pairs[0].seen, 0u);
    EXPECT_EQ(fights.pairs[0].nearer, 1u);
    EXPECT_EQ(fights.pairs[0].samples, fights.wrong);
    EXPECT_NEAR(fights.pairs[0].farthest / (gap * 0.02), 1, 0.01);
    EXPECT_NEAR(double(fights.errors[77]) * 40 / (gap * 0.02), 1, 0.01);
  }
}

TEST(DepthFights, SurfacesInOnePlaneAreTiedAndNotWrong) {
  const Scene scene = two_squares(7, 7);
  const Surfaces surfaces(scene);
  const View view = square_view(0.1, 100);
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::f32}) {
    const DepthFights fights = fights_with(surfaces, view, format);
    EXPECT_EQ(fights.wrong, 0u);
    EXPECT_EQ(fights.tied, view.pixel_count());
  }
}

// A depth that rounds to the far plane's does not pass LESS against the clear value.
TEST(DepthFights, WhatRoundsToTheClearValueIsNotSeen) {
  const Scene scene = two_squares(90, 95);
  const Surfaces surfaces(scene);
  const DepthFights fights = fights_with(surfaces, square_view(0.01, 100), DepthFormat::d8);
  EXPECT_EQ(fights.wrong, fights.covered);
  EXPECT_EQ(fights.pairs.at(0).seen, no_index);
  EXPECT_TRUE(std::isinf(fights.errors[5]));
  const Image picture = fight_image(fights, [] {
    Image backdrop{64, 64, {}};
    for (const char* name : {"R", "G", "B"}) backdrop.channels.push_back({name, Buffer<float>(64 * 64, 1.0f)});
    return backdrop;
  }());
  EXPECT_EQ(picture.find("B")->floats()[5], 1.0f);
}

TEST(DepthFights, FinerFormatsFightLessAndTheDefaultHardlyEver) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 200, 3));
  const Surfaces surfaces(scene);
  Random random(2);
  View view = random_view(random, 300, 200);
  view.projection = make_projection(0.9, 1.5, {0.01, 60});
  const std::uint64_t d8 = fights_with(surfaces, view, DepthFormat::d8).wrong;
  const std::uint64_t d16 = fights_with(surfaces, view, DepthFormat::d16).wrong;
  const std::uint64_t d24 = fights_with(surfaces, view, DepthFormat::d24).wrong;
  const std::uint64_t f32 = fights_with(surfaces, view, DepthFormat::f32, true).wrong;
  EXPECT_GT(d8, d16);
  EXPECT_GT(d16, d24);
  EXPECT_LE(f32, d24);
  EXPECT_EQ(f32, find_depth_fights(surfaces, find_exact_visible(surfaces, view), zbuffer(surfaces, view)).wrong);
  EXPECT_LT(f32, 20u);
}

TEST(DepthFights, TheSameCameraGivesTheSamePattern) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 8));
  const Surfaces surfaces(scene);
  Random random(4);
  const View view = random_view(random, 200, 160);
  const Visible answer = [&] {
    DepthBuffer buffer(200, 160, 1, DepthFormat::d8);
    buffer.draw(surfaces, view);
    return buffer.visible(view);
  }();
  const auto pattern = [&](int threads) {
    const Execution execution{.threads = threads};
    const DepthFights fights =
        find_depth_fights(surfaces, find_exact_visible(surfaces, view, execution), answer, execution);
    return std::vector<float>(fights.errors.begin(), fights.errors.end());
  };
  const std::vector<float> once = pattern(1);
  EXPECT_EQ(pattern(1), once);
  EXPECT_EQ(pattern(5), once);
  EXPECT_GT(std::count_if(once.begin(), once.end(), [](float e) { return e > 0; }), 10);
}

TEST(DepthFights, OtherViewsAreRefused) {
  const Scene scene = two_squares(3, 4);
  const Surfaces surfaces(scene);
  View view = square_view(1, 10);
  const ExactVisible exact = find_exact_visible(surfaces, view);
  view.width = 32;
  EXPECT_THROW((void)find_depth_fights(surfaces, exact, zbuffer(surfaces, view)), Error);
}

TEST(TooMuch, SheetsWhoseDepthsDoublesDoNotTellApart) {
  const Scene scene = scene_of(parallel_sheets(10000, 1e-7));
  const Surfaces surfaces(scene);
  EXPECT_EQ(
      refusal_of(ErrorCode::limit_exceeded, [&] { (void)find_exact_visible(surfaces, frame(surfaces, 640, 480)); }),
      "exact depths: too many of 20000 triangles lie over each other in the picture");
}

}  // namespace
}  // namespace frontmost::test
