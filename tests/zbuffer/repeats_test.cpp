// SPDX-License-Identifier: Apache-2.0
// Triangles repeated twice or a million times: the first one is visible, at the cost of the first.

#include <gtest/gtest.h>

#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

View front_view(int width, int height) {
  return make_view(0.9, width, height).looking({0, 0, 2}, {0, 0, 0}, {0, 1, 0}).between(0.1, 10);
}

/// Some meshes in a few placements each, many of these repeated; each mesh has repeated triangles.
Scene crowded(Kind kind, std::uint64_t seed) {
  Random random(seed + 9);
  Scene scene;
  for (std::uint64_t m = 0; m < 3; ++m) {
    Mesh mesh = random_mesh(kind, 20 + random.below(60), seed * 3 + m);
    for (int i = 0; i < 30; ++i) mesh.triangles.push_back(mesh.triangles[std::size_t(random.below(20))]);
    scene.meshes.push_back(std::move(mesh));
  }
  for (int i = 0; i < 24; ++i) {
    const auto mesh = std::uint32_t(random.below(3));
    glm::dmat4 place(1.0);
    place[3][0] = 0.25 * random.below(3);
    if (random.below(3) == 0) place[1][1] = -1;
    scene.instances.push_back({"object", mesh, place});
  }
  return scene;
}

class RepeatsOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Repeats, RepeatsOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(RepeatsOfEveryKind, ChangeNothingThatIsSeen) {
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Scene scene = crowded(GetParam(), seed);
    const Surfaces surfaces(scene);
    Random random(seed);
    View view = random_view(random, 90 + 200 * int(seed % 2), 70);
    view.culling = Culling(random.below(3));
    const Visible expected = oracle(surfaces, view);
    expect_same(expected, draw_both_ways(surfaces, view));
  }
}

// Every triangle fills the picture, so drawing all of them would take minutes.
TEST(Repeats, AMillionTakeTheTimeToCountThem) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) add_triangle(mesh, {-9, -9, 0}, {9, -9, 0.1f}, {0, 9, 0});
  Scene scene = scene_of(std::move(mesh));
  scene.instances.resize(tries_little ? 1'000 : 300'000, scene.instances[0]);
  View view = front_view(1000, 800);
  view.samples = 4;
  const Visible visible = draw_both_ways(Surfaces(scene), view);
  for (const PrimitiveId id : visible.primitives) ASSERT_EQ(id, 0u);
}

// Triangles of a few tiles are not sorted beforehand; drawing so many would take half a minute.
TEST(Repeats, AMillionOfMiddleSizeDoToo) {
  Mesh mesh;
  add_triangle(mesh, {-0.4f, -0.4f, 0}, {0.4f, -0.3f, 0.1f}, {0, 0.5f, 0});
  add_triangle(mesh, {-0.2f, -0.5f, 0.05f}, {0.3f, -0.4f, 0}, {0.2f, 0.6f, 0});
  const Scene once = scene_of(std::move(mesh));
  Scene often = once;
  often.instances.resize(tries_little ? 1'000 : 500'000, once.instances[0]);
  View view = front_view(500, 400);
  view.samples = 4;
  const Visible expected = draw_both_ways(Surfaces(once), view);
  expect_same(expected, draw_both_ways(Surfaces(often), view));
}

}  // namespace
}  // namespace frontmost::test
