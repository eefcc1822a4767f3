// SPDX-License-Identifier: Apache-2.0
// Triangles with holes in the z-buffer's tiles: against the oracle, behind and in front of others, and as copies.
#include <gtest/gtest.h>

#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/oracle.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

class CutoutsOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(ZBuffer, CutoutsOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(CutoutsOfEveryKind, EqualTheOracleOnEveryInstructionSet) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 300);
    const Scene scene = cutout_scene(random_mesh(GetParam(), 400, seed), Cut(seed % 2), 0.5f, seed);
    const Surfaces surfaces(scene);
    View view = random_view(random, 20 + random.below(250), 20 + random.below(150));  // up to six tiles
    view.samples = seed % 4 == 3 ? 4 : 1;
    view.culling = Culling(seed % 3);
    const Visible expected = oracle(surfaces, view);
    seen += covered(expected);
    for (const Isa isa : available_isas())
      expect_same(expected, draw_both_ways(surfaces, view, {.threads = 1 + int(seed % 2), .isa = isa}));
  }
  EXPECT_GT(seen, 60u) << "the scenes have become empty";
}

/// A triangle three times at one place, all cutouts: the first one is all hole, the next two are solid.
Scene copies(float size) {
  Mesh mesh;
  mesh.positions = {{-size, -size, 0}, {size, -size, 0}, {0, size, 0}};
  mesh.triangles.assign(3, {0, 1, 2});
  mesh.material_ids = {0, 1, 1};
  Scene scene = scene_of(std::move(mesh));
  scene.materials.resize(2);
  for (Material& material : scene.materials) material.alpha = Material::Alpha::mask;
  scene.materials[0].alpha_cutoff = 2;
  return scene;
}

// Only the first of copies without holes is drawn; if copies have holes, a later one may be visible.
TEST(ZBuffer, CopiesOfACutoutHaveHolesOfTheirOwn) {
  View view;
  view.width = view.height = 600;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-1, 1, -1, 1, {1, 20});
  for (const float size : {0.005f, 0.05f, 0.3f, 0.9f, 100.0f}) {  // from a few pixels to beyond the guard band
    SCOPED_TRACE(testing::Message() << "size " << size);
    const Scene scene = copies(size);
    const Visible visible = draw_both_ways(Surfaces(scene), view);
    EXPECT_EQ(visible.primitives[visible.index(300, 300)], 1u);
    EXPECT_EQ(std::count(visible.primitives.begin(), visible.primitives.end(), 0u), 0);
    EXPECT_EQ(std::count(visible.primitives.begin(), visible.primitives.end(), 2u), 0);
  }
}

// Tiles that a frame leaves blank keep their content, and tiles with nothing but holes behave like them.
TEST(ZBuffer, FramesOfCutoutsFollowEachOther) {
  const Scene scene = cutout_scene(random_mesh(Kind::soup, 60, 1), Cut::all, 0.5f, 1);
  const Surfaces surfaces(scene);
  Random random(9);
  ZBuffer buffer;
  for (int i = 0; i < 12; ++i) {
    const View view = random_view(random, 300, 200);
    expect_same(oracle(surfaces, view), buffer.draw(surfaces, view));
  }
}

}  // namespace
}  // namespace frontmost::test
