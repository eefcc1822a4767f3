// SPDX-License-Identifier: Apache-2.0
// Visible and hidden parts against every triangle of the scene, point by point.
#include <gtest/gtest.h>

#include "frontmost/lines.h"
#include "support/effort.h"
#include "support/point_oracle.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

struct Checked {
  std::size_t asked = 0, certain = 0;
};

Checked check(const Scene& scene, const View& view, bool counts, std::uint64_t seed) {
  const Surfaces surfaces(scene);
  const Drawing drawing = draw_lines(surfaces, view, {.crease_angle = 0, .counts_hidden = counts, .outlines = !counts});
  const PointOracle oracle(surfaces, view);
  Random random(seed);
  Checked checked;
  const DrawnPart* before = nullptr;
  for (const DrawnPart& part : drawing.parts) {
    if (before && before->edge == part.edge) {
      EXPECT_EQ(before->end, part.begin);
      EXPECT_EQ(before->to, part.from);
      EXPECT_TRUE(before->hidden_by != part.hidden_by || before->is_outline != part.is_outline);
    }
    before = &part;
    EXPECT_LT(part.begin, part.end);
    const DrawnEdge& edge = drawing.edges[part.edge];
    const double t = part.begin + (part.end - part.begin) * random.within(0.1f, 0.9f);
    const PointOracle::Answer answer = oracle.ask(edge.from + (edge.to - edge.from) * t, edge);
    ++checked.asked;
    if (!answer.is_certain) continue;
    ++checked.certain;
    if (counts)
      EXPECT_EQ(part.hidden_by, answer.hidden_by) << part.edge << " at " << t;
    else
      EXPECT_EQ(part.hidden_by != 0, answer.hidden_by != 0) << part.edge << " at " << t;
  }
  return checked;
}

class EveryKind : public testing::TestWithParam<Kind> {};

TEST_P(EveryKind, IsHiddenWhereATriangleIsBefore) {
  Checked all;
  for (std::uint64_t seed = 0; seed < (tries_little ? 2u : 8u); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 100);
    // All sheets pass through each other: hundreds of thousands of segments.
    const Scene scene = scene_of(random_mesh(GetParam(), GetParam() == Kind::sheets ? 30 : 150, seed));
    View view = random_view(random, 160, 120);
    const Checked checked = check(scene, view, seed % 2 == 0, seed);
    all.asked += checked.asked;
    all.certain += checked.certain;
  }
  // Coplanar triangles are all in doubt.
  EXPECT_GT(double(all.certain), GetParam() == Kind::coplanar ? 0 : 0.99 * double(all.asked));
  EXPECT_GT(all.asked, 30u);
}

INSTANTIATE_TEST_SUITE_P(Lines, EveryKind, testing::ValuesIn(all_kinds));

TEST(Lines, TellProgressAndStopWhenAsked) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 3000, 5));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 240);
  double last = 0;
  Watch watch;
  watch.progress = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "lines");
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  (void)draw_lines(surfaces, view, {}, {.threads = 1, .watch = &watch});
  EXPECT_EQ(last, 1);
  for (const std::size_t question : {1, 4, 11})
    EXPECT_THROW((void)draw_lines(surfaces, view, {}, CountingWatch(question).execution()), Error);
}

void expect_same(const Drawing& one, const Drawing& other) {
  ASSERT_EQ(one.edges.size(), other.edges.size());
  for (std::size_t i = 0; i < one.edges.size(); ++i) {
    ASSERT_EQ(one.edges[i].from, other.edges[i].from);
    ASSERT_EQ(one.edges[i].to, other.edges[i].to);
    ASSERT_EQ(one.edges[i].kind, other.edges[i].kind);
  }
  ASSERT_EQ(one.parts.size(), other.parts.size());
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    ASSERT_EQ(one.parts[i].edge, other.parts[i].edge);
    ASSERT_EQ(one.parts[i].end, other.parts[i].end);
    ASSERT_EQ(one.parts[i].to, other.parts[i].to);
    ASSERT_EQ(one.parts[i].hidden_by, other.parts[i].hidden_by);
  }
}

TEST(Lines, ThreadsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 3000, 5));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 240);
  const Drawing one = draw_lines(surfaces, view, {}, {.threads = 1}),
                three = draw_lines(surfaces, view, {}, {.threads = 3});
  expect_same(one, three);
}

TEST(Lines, OfOneViewAfterAnotherAreThoseOfEachAlone) {
  for (const Kind kind : {Kind::sheets, Kind::coplanar, Kind::soup}) {
    Mesh mesh = random_mesh(kind, kind == Kind::sheets ? 30 : 150, 4);
    // A seam with a T-junction, which a triangle without area fills.
    const glm::vec3 a(0, 0, 0), b(1, 0, 0), middle(0.5f, 0, 0), above(0.5f, 0.7f, 0), below(0.5f, -0.7f, 0);
    add_triangle(mesh, a, b, above);
    add_triangle(mesh, a, middle, b);
    add_triangle(mesh, a, below, middle);
    add_triangle(mesh, middle, below, b);
    // Borders of materials and of objects, and stated edges.
    mesh.sharp_edges = {{0, 1}, {mesh.triangles[2].y, mesh.triangles[2].z}};
    Scene scene = scene_of(mesh);
    scene.materials.resize(2);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      scene.meshes[0].material_ids.push_back(std::uint32_t(t % 3 == 0));
    scene.instances.push_back(scene.instances[0]);
    scene.instances[1].world_from_mesh[3] += glm::dvec4(0.3, 0.1, 0, 0);
    const Surfaces surfaces(scene);
    LineDrawer drawer(surfaces);
    Random random(17);
    // A first view that is cancelled leaves a drawer that can be used.
    EXPECT_THROW((void)drawer.draw(random_view(random, 160, 120), {}, CountingWatch(3).execution()), Error);
    for (int i = 0; i < 8; ++i) {
      const View view = random_view(random, 160, 120);
      LineOptions options{
          .counts_hidden = i % 2 == 0, .silhouettes = i != 4, .intersections = i % 3 != 0, .ripples = i > 2};
      if (i == 5) options.crease_angle = 0.5;
      options.boundaries = i != 6;
      options.borders = i % 4 != 1;
      options.creases = i != 7;
      expect_same(draw_lines(surfaces, view, options), drawer.draw(view, options, {.threads = 1 + i % 3}));
    }
    EXPECT_THROW((void)drawer.draw(View(), {}), Error);
    EXPECT_THROW((void)drawer.draw(random_view(random, 16, 16), {.crease_angle = -1}), Error);
  }
}

/// Enough triangles for several parts of every step; some cover many cells and lie in every part.
TEST(Lines, PartsOfManyTrianglesAreOneGrid) {
  Random random(7);
  Mesh mesh;
  for (std::uint32_t t = 0; t < 24'000; ++t) {
    const float size = t % 400 == 0 ? 0.5f : 0.01f;
    const glm::vec3 middle(random.within(-1, 1), random.within(-1, 1), random.within(-1, 1));
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(middle +
                               size * glm::vec3(random.within(-1, 1), random.within(-1, 1), random.within(-1, 1)));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 240);
  for (const bool counts : {false, true}) {
    const LineOptions options{.counts_hidden = counts, .intersections = false};
    const Drawing drawing = draw_lines(surfaces, view, options, {.threads = 1});
    expect_same(drawing, draw_lines(surfaces, view, options, {.threads = 4}));
    const PointOracle oracle(surfaces, view);
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < drawing.parts.size(); i += tries_little ? 3000 : 300) {
      const DrawnPart& part = drawing.parts[i];
      const DrawnEdge& edge = drawing.edges[part.edge];
      const PointOracle::Answer answer =
          oracle.ask(edge.from + (edge.to - edge.from) * ((part.begin + part.end) / 2), edge);
      if (!answer.is_certain) continue;
      EXPECT_EQ(part.hidden_by, counts ? answer.hidden_by : std::min(answer.hidden_by, 1u));
      hidden += part.hidden_by > 0;
    }
    EXPECT_GT(hidden, tries_little ? 5u : 50u);
  }
}

}  // namespace
}  // namespace frontmost::test
