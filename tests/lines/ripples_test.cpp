// SPDX-License-Identifier: Apache-2.0
// Silhouettes of ripples: they vanish from rough surfaces; outlines and other kinds of edges stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "frontmost/lines.h"
#include "support/tessellations.h"

namespace frontmost::test {
namespace {

constexpr int kSquares = 40;

Mesh rough_plate() {
  return bent(kSquares, 0.05f, [](float) { return 0.0f; });
}
Mesh rough_waves() {
  return bent(60, 0.1f, [](float x) { return 0.1f * std::sin(20 * x); });
}
Mesh tube(double radius, double noise) {
  Random random(3);
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= kSquares; ++i) {
    const std::uint64_t seed = random.below(1000);
    profile.push_back([=](double angle) {
      Random here(seed + std::uint64_t(angle * 1000));
      return glm::dvec2(radius + double(here.within(0, float(noise))), 0.1 * i);
    });
  }
  Mesh mesh;
  add_sides(mesh, profile, even_angles(60));
  return mesh;
}

View seen_along(const Surfaces& surfaces, const glm::dvec3& forward, bool is_parallel) {
  return frame(surfaces, 400, 400, {.orthographic = is_parallel, .forward = forward});
}

Drawing drawn(const Surfaces& surfaces, const View& view, bool with_ripples, const Execution& execution = {}) {
  return draw_lines(surfaces, view, {.ripples = with_ripples, .outlines = true}, execution);
}

/// The length of seen silhouettes, in pixels; of outlines alone, or of others.
double silhouettes_of(const Drawing& drawing, bool is_outline) {
  double sum = 0;
  for (const DrawnPart& part : drawing.parts)
    if (part.hidden_by == 0 && part.is_outline == is_outline && drawing.edges[part.edge].kind == EdgeKind::silhouette)
      sum += glm::distance(part.from, part.to);
  return sum;
}

TEST(Ripples, VanishFromARoughPlateSeenNearlyEdgeOn) {
  const Scene scene = scene_of(rough_plate());
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true})
    for (const auto& [height, most] : {std::pair(0.02, 0.5), std::pair(0.05, 0.1)}) {
      const View view = seen_along(surfaces, {0.3, 1, -height}, is_parallel);
      const double all = silhouettes_of(drawn(surfaces, view, true), false);
      EXPECT_GT(all, 1000);
      EXPECT_LT(silhouettes_of(drawn(surfaces, view, false), false), most * all) << is_parallel << ' ' << height;
    }
}

TEST(Ripples, OutlinesStay) {
  Random random(8);
  for (const Mesh& mesh : {rough_plate(), rough_waves(), tube(1, 0.01), tube(1, 0)}) {
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    for (int i = 0; i < 16; ++i) {
      const glm::dvec3 forward = glm::dvec3(random.point(1)) * glm::dvec3(1, 1, i % 2 == 0 ? 1 : 0.05);
      View view = seen_along(surfaces, forward, i % 3 == 0);
      // From above the middle, part of the surface lies behind the eye.
      const glm::dvec3 eye(0.5, 0.5, 0.15);
      if (i >= 12) view = make_view(1, 400, 400).looking(eye, eye + forward, {0, 0, 1}).between(0.01, 10);
      const double all = silhouettes_of(drawn(surfaces, view, true), true);
      EXPECT_GE(silhouettes_of(drawn(surfaces, view, false), true), 0.99 * all - 0.5) << i;
    }
  }
}

TEST(Ripples, OfSmoothShapesThereAreNone) {
  for (const int sides : {18, 36, 200}) {
    std::vector<ProfilePoint> half_circle;
    for (int i = 0; i <= sides / 2; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      half_circle.push_back(at(i == 0 || 2 * i == sides ? 0 : std::sin(angle), -std::cos(angle)));
    }
    Mesh ball;
    add_sides(ball, half_circle, even_angles(sides));
    const Scene scene = scene_of(ball);
    const Surfaces surfaces(scene);
    for (const glm::dvec3& forward : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 2, -3)}) {
      const View view = seen_along(surfaces, forward, true);
      EXPECT_EQ(drawn(surfaces, view, false).edges.size(), drawn(surfaces, view, true).edges.size()) << sides;
    }
  }
}

TEST(Ripples, StayWhereTheyAreCreasesOrBorders) {
  Mesh mesh = rough_plate();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.material_ids.push_back(std::uint32_t(i / 200 % 2));
  Scene scene = scene_of(mesh);
  scene.materials.resize(2);
  const Surfaces surfaces(scene);
  const View view = seen_along(surfaces, {0.3, 1, -0.05}, true);
  const auto count = [&](const LineOptions& options) { return draw_lines(surfaces, view, options).edges.size(); };
  // At an angle of 0 every edge is a crease.
  EXPECT_EQ(count({.crease_angle = 0, .ripples = false}), count({.crease_angle = 0}));
  const std::size_t in_every_view = count({.crease_angle = 3, .silhouettes = false});
  EXPECT_GT(in_every_view, std::size_t(4 * kSquares));
  const std::size_t without = count({.crease_angle = 3, .ripples = false});
  EXPECT_GE(without, in_every_view);
  EXPECT_LT(without, in_every_view + (count({.crease_angle = 3}) - in_every_view) / 5);
}

TEST(Ripples, ThreadsAndInstructionSetsChangeNothing) {
  const Scene scene = scene_of(rough_waves());
  const Surfaces surfaces(scene);
  const View view = seen_along(surfaces, {1, 1, -0.1}, false);
  const Drawing one = drawn(surfaces, view, false, {.threads = 1});
  for (const Execution& execution : {Execution{.threads = 5}, Execution{.threads = 1, .isa = Isa::scalar}}) {
    const Drawing other = drawn(surfaces, view, false, execution);
    ASSERT_EQ(one.edges.size(), other.edges.size());
    for (std::size_t i = 0; i < one.edges.size(); ++i) {
      EXPECT_EQ(one.edges[i].from, other.edges[i].from);
      EXPECT_EQ(one.edges[i].kind, other.edges[i].kind);
    }
  }
}

}  // namespace
}  // namespace frontmost::test
