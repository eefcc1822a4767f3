// SPDX-License-Identifier: Apache-2.0
// Orders from which most hidden polygons are removed beforehand.
#include <gmock/gmock.h>

#include "painter/painted.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;

TEST(Hidden, IsNeverCut) {
  Mesh mesh = random_mesh(Kind::sheets, 40, 1);
  for (glm::vec3& p : mesh.positions) p = p * 0.2f;
  add_square(mesh, 1.5f, 2);
  const auto first = PrimitiveId(mesh.triangles.size() - 2);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true}) {
    const View view = view_from_above(is_parallel, 256);
    EXPECT_GT(painter(surfaces, view).steps.cuts, 0u);
    const PaintOrder order = painter(surfaces, view, {.occluders = Occluders::all()});
    EXPECT_EQ(order.steps.cuts, 0u);
    EXPECT_THAT(ids_of(order), testing::UnorderedElementsAre(first, first + 1));
    // Everything behind glass is visible.
    const auto is_no_glass = [&](PrimitiveId id) { return id < first; };
    EXPECT_GT(painter(surfaces, view, {.occluders = Occluders::where(is_no_glass)}).polygons.size(), 20u);
  }
}

TEST(Hidden, InOnePlaneTheLowerIdIsLeft) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) add_square(mesh, 1, 0.25f);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true})
    EXPECT_THAT(ids_of(painter(surfaces, view_from_above(is_parallel, 256), {.occluders = Occluders::all()})),
                ElementsAre(1, 0));
}

/// A triangle that passes through another hides it on one side only.
TEST(Hidden, WhatComesThroughStays) {
  Mesh mesh;
  add_square(mesh, 1, 0);
  add_triangle(mesh, {-0.5f, -0.6f, -0.2f}, {0.5f, -0.6f, -0.2f}, {0, 0.5f, 0.01f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, view_from_above(false, 256), {.occluders = Occluders::all()});
  EXPECT_THAT(ids_of(order), testing::Contains(2u));
}

/// The picture's border passes through a vertex, which then occurs twice in the clipped polygon.
TEST(Hidden, WhatReachesBeyondThePictureIsSeenBesideItsMiddle) {
  Mesh mesh;
  add_triangle(mesh, {-2, -1, 0}, {1, 0, 0}, {-3, 1.5f, 0});
  add_triangle(mesh, {-1.3f, -0.6f, 1}, {-0.3f, -0.1f, 1}, {-1.2f, 0.6f, 1});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, view_from_above(true), {.occluders = Occluders::all()});
  EXPECT_THAT(ids_of(order), testing::UnorderedElementsAre(0, 1));
}

/// On the screen the grain is nearly a point, in the middle of the surface behind it.
TEST(Hidden, AGrainHidesNothing) {
  for (const int power : {20, 30, 33, 40, 60, 120}) {
    const float size = std::ldexp(1.0f, -power);
    Mesh mesh;
    add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {0, 2, 0});
    add_triangle(mesh, {0, 0, 1}, {size, 0, 1}, {0, size, 1});
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    const PaintOrder order = painter(surfaces, view_from_above(true), {.occluders = Occluders::all()});
    EXPECT_THAT(ids_of(order), testing::Contains(0u)) << power;
    EXPECT_THAT(ids_of(visible_parts(order)), testing::Contains(0u)) << power;
  }
}

TEST(Hidden, ThePictureIsTheSame) {
  std::size_t samples = 0, differing = 0, before = 0, left = 0;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
      Random random(seed + 70);
      const Scene scene = scene_of(random_mesh(kind, kind == Kind::sheets ? 20 : 150, seed));
      const Surfaces surfaces(scene);
      const View view = random_view(random, 120, 90);
      const PaintOrder whole = painter(surfaces, view),
                       order = painter(surfaces, view, {.occluders = Occluders::all()});
      const Visible expected = paint(surfaces, whole), found = paint(surfaces, order);
      for (std::size_t i = 0; i < expected.primitives.size(); ++i)
        differing += expected.primitives[i] != found.primitives[i];
      samples += expected.primitives.size();
      before += whole.polygons.size();
      left += order.polygons.size();
    }
  EXPECT_LT(double(differing), 1e-4 * double(samples));  // snapped vertices, as for visible_parts()
  EXPECT_LT(left, before * 3 / 4);
}

TEST(Hidden, ThreadsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 4000, 2));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 160, 120);
  EXPECT_EQ(ids_of(painter(surfaces, view, {.occluders = Occluders::all()}, {.threads = 1})),
            ids_of(painter(surfaces, view, {.occluders = Occluders::all()}, {.threads = 3})));
}

}  // namespace
}  // namespace frontmost::test
