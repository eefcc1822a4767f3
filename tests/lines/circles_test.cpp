// SPDX-License-Identifier: Apache-2.0
// Round shapes of a model are round on paper: circles of known radii, and rings that coincide except for their
// tessellation.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "frontmost/files.h"
#include "frontmost/lines.h"
#include "support/models.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using std::numbers::pi;

/// Number of full turns, by radius in hundredths of the model's unit.
using TurnsByRadius = std::map<int, double>;

TurnsByRadius turns_of(const Strokes& all, double units_per_pixel) {
  TurnsByRadius rounds;
  for (const Stroke& stroke : all.strokes)
    for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i) {
      const double bulge = std::abs(all.bulges[stroke.first + i]);
      if (bulge == 0) continue;
      const double chord =
          glm::distance(all.points[stroke.first + i], all.points[stroke.first + (i + 1) % stroke.count]) *
          units_per_pixel;
      rounds[int(std::lround(100 * chord * (1 + bulge * bulge) / (4 * bulge)))] += 4 * std::atan(bulge) / (2 * pi);
    }
  return rounds;
}

/// Draws a model in parallel projection, at full scale.
TurnsByRadius turns_of(const Scene& scene, NamedView direction) {
  const Surfaces surfaces(scene);
  FrameOptions options;
  options.direction = direction;
  options.orthographic = true;
  const View view = frame(surfaces, 3840, 2160, options);
  const double scale = (view.projection.right - view.projection.left) / view.width;
  StrokeOptions drawn{.by_kind = false, .by_outline = false};
  drawn.apart = drawn.arc_tolerance = 0.01 / scale;
  return turns_of(chain_strokes(surfaces, draw_lines(surfaces, view), drawn), scale);
}

TEST(Circles, OfModelsHaveTheirRadii) {
  FRONTMOST_NEEDS_MODELS();
  const Scene as1 = load(model("cad/as1.stl"));
  // The six bolts have 10 mm, and heads of 15 mm that lie free except for two below the rod.
  const TurnsByRadius bolts = turns_of(as1, NamedView::top);
  EXPECT_NEAR(bolts.at(500), 6, 1e-3);
  EXPECT_NEAR(bolts.at(750), 4, 1e-3);
  const Scene tubes = load(model("cad/two-cylinders.stl"));
  const TurnsByRadius ends = turns_of(tubes, NamedView::top);
  EXPECT_NEAR(ends.at(1000), 1, 1e-3);
  EXPECT_NEAR(ends.at(800), 1, 1e-3);
  const Scene torus = load(model("cad/torus.stl"));
  const TurnsByRadius ring = turns_of(torus, NamedView::top);
  EXPECT_NEAR(ring.at(4000), 1, 1e-3);
  EXPECT_NEAR(ring.at(2000), 1, 1e-3);
}

TEST(Circles, TheRodOfAnAssemblyIsStraight) {
  FRONTMOST_NEEDS_MODELS();
  // Nothing in the model is rounder than a plate is thick, and its rod is straight, though it ends in tiny chords.
  for (const auto& [radius, turns] : turns_of(load(model("cad/as1.stl")), NamedView::iso))
    if (turns > 0) {
      EXPECT_LT(radius, 5000);
    }
}

/// A flat ring with `corners` vertices on its outer side, at height z.
void add_disc(Mesh& mesh, int corners, float z) {
  for (int i = 0; i < corners; ++i) {
    const auto corner = [&](int k) {
      return glm::vec3(std::cos(2 * pi * k / corners), std::sin(2 * pi * k / corners), z);
    };
    add_triangle(mesh, {0, 0, z}, corner(i), corner(i + 1 < corners ? i + 1 : 0));
  }
}

TEST(Circles, RingsThatDifferByTheirTrianglesAreOne) {
  Mesh mesh;
  add_disc(mesh, 60, 0.5f);
  add_disc(mesh, 97, 0);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 400;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {0.5, 50});
  const Drawing drawing = draw_lines(surfaces, view);
  // Vertices of the finer ring stand over the middles of the coarser one's edges, off by up to a seventh of a pixel.
  StrokeOptions options{.with_hidden = false, .arc_tolerance = 0.2};
  EXPECT_GT(chain_strokes(surfaces, drawing, options).strokes.size(), 20u);
  options.apart = 0.2;
  const Strokes one = chain_strokes(surfaces, drawing, options);
  ASSERT_EQ(one.strokes.size(), 1u);
  EXPECT_TRUE(one.strokes[0].is_closed);
  EXPECT_NEAR(turns_of(one, 0.01).at(100), 1, 1e-6);
}

}  // namespace
}  // namespace frontmost::test
