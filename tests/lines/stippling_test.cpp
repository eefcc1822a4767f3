// SPDX-License-Identifier: Apache-2.0
// Dots: their number follows the darkness, they are evenly spread, and none are elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "frontmost/lines.h"
#include "hatching/dot_grid.h"
#include "support/effort.h"
#include "support/hatch_oracle.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

void add_level_square(Mesh& mesh, float half, float height) {
  const glm::vec3 a(-half, -half, height), b(half, -half, height), c(half, half, height), d(-half, half, height);
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

/// A view from above: 4 by 4 units on 400 by 400 pixels.
View from_above() {
  View view;
  view.width = view.height = 400;
  view.world_from_eye = look_at({0, 0, 10}, glm::dvec3(0), glm::dvec3(0, 1, 0));
  view.projection = make_orthographic(-2, 2, -2, 2, {0.5, 50});
  return view;
}

StippleOptions options_of(double spacing, const glm::dvec3& to_light) {
  StippleOptions options;
  options.spacing = spacing;
  options.tone.to_light = to_light;
  return options;
}

/// Dots on a square of 3.2 units, 320 pixels, with brightness `cosine`: ten periods of the pattern at spacing 1.
std::vector<Stipple> dots_at(double cosine, double spacing) {
  Mesh mesh;
  add_level_square(mesh, 1.6f, 0);
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  return stipple(surfaces, from_above(), options_of(spacing, {std::sqrt(1 - cosine * cosine), 0, cosine}));
}

std::set<std::pair<double, double>> places(const std::vector<Stipple>& dots) {
  std::set<std::pair<double, double>> all;
  for (const Stipple& dot : dots) all.emplace(dot.at.x, dot.at.y);
  return all;
}

TEST(Stipple, ThereAreAsManyDotsAsItIsDark) {
  for (const double cosine : {0.05, 0.2, 0.5, 0.7, 0.9}) {
    const double share = (0.95 - cosine) * (0.95 - cosine);
    EXPECT_NEAR(double(dots_at(cosine, 2).size()), 160 * 160 * share, 160 * 160 * 0.003) << cosine;
  }
  EXPECT_TRUE(dots_at(0.96, 2).empty());
  EXPECT_TRUE(dots_at(1, 2).empty());
}

TEST(Stipple, DarkerOnesKeepTheDotsOfLighterOnes) {
  const auto dark = places(dots_at(0.2, 3)), light = places(dots_at(0.6, 3));
  EXPECT_GT(light.size(), 500u);
  EXPECT_TRUE(std::includes(dark.begin(), dark.end(), light.begin(), light.end()));
}

TEST(Stipple, DotsKeepApart) {
  for (const double cosine : {0.05, 0.5, 0.8}) {
    const std::vector<Stipple> dots = dots_at(cosine, 4);
    const double typical = 4 / (0.95 - cosine);
    double sum = 0, least = 1e300;
    for (const Stipple& dot : dots) {
      double nearest = 1e300;
      for (const Stipple& other : dots)
        if (&other != &dot) nearest = std::min(nearest, glm::distance(dot.at, other.at));
      sum += nearest;
      least = std::min(least, nearest);
    }
    // For random dots, the mean distance to the nearest would be half as large, and some distances a tenth.
    EXPECT_GT(sum / double(dots.size()), 0.65 * typical) << cosine;
    EXPECT_GT(least, 0.25 * typical) << cosine;
  }
}

TEST(Stipple, ShadowsAreFull) {
  Mesh floor, plate;
  add_level_square(floor, 1.6f, 0);
  add_level_square(plate, 0.4f, 0.25f);
  Scene scene = scene_of(std::move(floor));
  scene.meshes.push_back(std::move(plate));
  scene.instances.push_back({"plate", 1, glm::dmat4(1.0)});
  const Surfaces surfaces(scene);
  // Light along (4, 0, -3) gives brightnesses of 0.6; the shadow is shifted a third of a unit to +x.
  const std::vector<Stipple> dots = stipple(surfaces, from_above(), options_of(2, {-4, 0, 3}));
  std::size_t in_shadow = 0, on_plate = 0;
  for (const Stipple& dot : dots) {
    const glm::dvec2 at = (dot.at - 200.0) / 100.0;
    const bool is_over_plate = std::abs(at.x) < 0.4 && std::abs(at.y) < 0.4;
    EXPECT_EQ(dot.instance, is_over_plate ? 1u : 0u);
    on_plate += is_over_plate;
    in_shadow += at.x > 0.4 && at.x < 0.4 + 1.0 / 3 && std::abs(at.y) < 0.4;
  }
  const double shadow = 0.8 / 3 * 10000 / 4;  // in squares of the spacing
  EXPECT_NEAR(double(in_shadow), shadow * 0.95 * 0.95, 0.05 * shadow);
  EXPECT_NEAR(double(on_plate), 0.64 * 10000 / 4 * 0.35 * 0.35, 20);
}

class EveryKindStippled : public testing::TestWithParam<Kind> {};

TEST_P(EveryKindStippled, OnlyWhereItIsSeenAndNotBright) {
  std::size_t certain = 0;
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 700);
    const Scene scene = scene_of(random_mesh(GetParam(), GetParam() == Kind::sheets ? 30 : 120, seed));
    const View view = random_view(random, 160, 120);
    const glm::dvec3 light = glm::dvec3(random.point(1)) + 0.01;
    StippleOptions options = options_of(5, light);
    options.tone.casts_shadows = seed % 2 == 0;
    options.tone.crease_angle = 0;
    const Surfaces surfaces(scene);
    HatchOptions like;
    like.sets = {{0, 1, 0, 0.95}};
    like.tone = options.tone;
    const HatchOracle oracle(surfaces, view, like);
    for (const Stipple& dot : stipple(surfaces, view, options)) {
      const HatchOracle::Answer answer = oracle.ask({dot.at, {1, 0}});
      certain += answer.is_certain;
      EXPECT_TRUE(!answer.is_certain || answer.is_dark) << dot.at.x << " " << dot.at.y;
    }
  }
  // Slivers and specks have little room for dots, and coplanar triangles are all in doubt.
  const bool has_few = GetParam() == Kind::slivers || GetParam() == Kind::tiny || GetParam() == Kind::coplanar;
  EXPECT_TRUE(has_few || certain > 5) << certain;
}

INSTANTIATE_TEST_SUITE_P(Stipple, EveryKindStippled, testing::ValuesIn(all_kinds));

TEST(Stipple, ThreadsOrderAndObjectsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 1000, 9));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 300, 200);
  StippleOptions options = options_of(2, {1, 2, 3});
  const std::vector<Stipple> one = stipple(surfaces, view, options, {.threads = 1});
  const std::vector<Stipple> five = stipple(surfaces, view, options, {.threads = 5});
  ASSERT_GT(one.size(), 500u);
  EXPECT_TRUE(std::equal(one.begin(), one.end(), five.begin(), five.end(),
                         [](const Stipple& a, const Stipple& b) { return a.at == b.at && a.instance == b.instance; }));
  options.by_instance = false;
  options.nearest_first = true;
  const std::vector<Stipple> ordered = stipple(surfaces, view, options);
  EXPECT_EQ(ordered.size(), one.size());
  EXPECT_EQ(places(ordered), places(one));
  double travel = 0;
  for (std::size_t i = 1; i < ordered.size(); ++i) travel += glm::distance(ordered[i - 1].at, ordered[i].at);
  EXPECT_LT(travel / double(ordered.size()), 6);
  for (const Stipple& dot : ordered) EXPECT_EQ(dot.instance, no_index);
}

TEST(Stipple, RefusesWhatMakesNoSense) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 10, 9)), none = scene_of({});
  const Surfaces surfaces(scene), nothing(none);
  const View view = frame(surfaces, 300, 200);
  for (const double bad : {0.0, 0.4, 1e6, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)stipple(surfaces, view, options_of(bad, {0, 0, 1})), Error);
  EXPECT_THROW((void)stipple(surfaces, view, options_of(2, {0, 0, 0})), Error);
  EXPECT_THROW((void)stipple(surfaces, frame(surfaces, 16384, 16384), options_of(2, {0, 0, 1})), Error);
  EXPECT_TRUE(stipple(nothing, view, options_of(2, {0, 0, 1})).empty());
}

TEST(DotGrid, HasItsPlacesWithinThePicture) {
  for (const double width : {64.0, 63.0, 0.5}) {
    const lines_detail::DotGrid grid(4, width);
    for (std::int32_t row = 0; row < lines_detail::DotGrid::side; ++row)
      grid.for_each(row, -1e300, 1e300, [&](double along, double) {
        EXPECT_GE(along, 0);
        EXPECT_LT(along, width);
      });
  }
}

}  // namespace
}  // namespace frontmost::test
