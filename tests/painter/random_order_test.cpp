// SPDX-License-Identifier: Apache-2.0
// Random scenes of every kind: the painted order is the z-buffer's picture.
#include <algorithm>
#include <vector>

#include "painter/painted.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Painter, EveryKind, testing::ValuesIn(all_kinds));

/// Kinds without coplanar triangles, where ids would decide which is seen.
class KindWithoutTies : public testing::TestWithParam<Kind> {};
std::vector<Kind> kinds_without_ties() {
  std::vector<Kind> kinds(std::begin(all_kinds), std::end(all_kinds));
  std::erase(kinds, Kind::coplanar);
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(Painter, KindWithoutTies, testing::ValuesIn(kinds_without_ties()));

RandomCase small_case(Kind kind, std::uint64_t seed) {
  Random random(seed + 900);
  // Sheets all intersect, and are nearly parallel: doubles decide hardly any sign.
  const int count = kind == Kind::sheets ? 5 + random.below(30) : 20 + random.below(120);
  RandomCase made{scene_of(random_mesh(kind, count, seed)), {}};
  const int width = 1 + random.below(120), height = 1 + random.below(100);
  made.view = random_view(random, width, height);
  made.view.culling = Culling(random.below(3));
  made.view.samples = seed % 4 == 3 ? 4 : 1;
  return made;
}

TEST_P(EveryKind, PaintsWhatTheZBufferShows) {
  std::uint64_t explained = 0, samples = 0;
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase c = small_case(GetParam(), seed);
    const Surfaces surfaces(c.scene);
    const Painted found = painted(surfaces, c.view, seed % 3 == 2 ? PaintMethod::bsp : PaintMethod::depth_sort);
    EXPECT_EQ(found.unexplained, 0u);
    explained += found.explained;
    samples += c.view.sample_count();
  }
  RecordProperty("explained", std::to_string(explained));
  if (GetParam() != Kind::coplanar) {
    EXPECT_LT(explained, samples / 20);
  }
}

TEST_P(EveryKind, PaintsByMaterialWhatTheZBufferShows) {
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    SCOPED_TRACE(seed);
    RandomCase c = small_case(GetParam(), seed);
    add_random_sides(c.scene, seed);
    c.view.culling = Culling::material;
    EXPECT_EQ(painted(Surfaces(c.scene), c.view, PaintMethod::depth_sort).unexplained, 0u);
  }
}

TEST_P(EveryKind, ThreadsChangeNothing) {
  const RandomCase c = small_case(GetParam(), 5);
  const Surfaces surfaces(c.scene);
  const PaintOrder one = painter(surfaces, c.view, {}, {.threads = 1}),
                   three = painter(surfaces, c.view, {}, {.threads = 3});
  EXPECT_EQ(ids_of(one), ids_of(three));
  ASSERT_EQ(one.corners.size(), three.corners.size());
  for (std::size_t i = 0; i < one.corners.size(); ++i) ASSERT_EQ(one.corners[i].at, three.corners[i].at);
}

/// In another order of the file, ids are queried in another order, and the picture is the same.
TEST_P(KindWithoutTies, TheOrderOfTheFileChangesNothing) {
  const RandomCase c = small_case(GetParam(), 7);
  Scene turned = c.scene;
  std::reverse(turned.meshes[0].triangles.begin(), turned.meshes[0].triangles.end());
  const Surfaces surfaces(c.scene), turned_surfaces(turned);
  const Visible a = paint(surfaces, painter(surfaces, c.view));
  Visible b = paint(turned_surfaces, painter(turned_surfaces, c.view));
  for (PrimitiveId& id : b.primitives)
    if (id != no_primitive) id = surfaces.primitive_count() - 1 - id;
  EXPECT_EQ(check_agreement(surfaces, a, b).count(Difference::unexplained), 0u);
}

/// Boxes on a grid that intersect: coplanar faces, edges on edges, vertices on faces.
TEST(Painter, BoxesOnAGridAreRight) {
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Mesh mesh;
    for (int box = 0; box < 12; ++box) {
      glm::vec3 low, high;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = float(random.below(6)) / 4 - 0.75f;
        high[axis] = low[axis] + float(1 + random.below(3)) / 4;
      }
      const auto first = std::uint32_t(mesh.positions.size());
      for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
      for (const glm::uvec3 t : {glm::uvec3(0, 2, 3), glm::uvec3(0, 3, 1), glm::uvec3(4, 5, 7), glm::uvec3(4, 7, 6),
                                 glm::uvec3(0, 1, 5), glm::uvec3(0, 5, 4), glm::uvec3(2, 6, 7), glm::uvec3(2, 7, 3),
                                 glm::uvec3(0, 4, 6), glm::uvec3(0, 6, 2), glm::uvec3(1, 3, 7), glm::uvec3(1, 7, 5)})
        mesh.triangles.push_back(t + first);
    }
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    View view = random_view(random, 100, 80);
    EXPECT_EQ(painted(surfaces, view).unexplained, 0u);
    view = view_from_above(seed % 2 == 0, 80);  // along the axes: half of the faces are seen edge-on
    EXPECT_EQ(painted(surfaces, view).unexplained, 0u);
    EXPECT_EQ(painted(surfaces, view, PaintMethod::bsp).unexplained, 0u);
  }
}

}  // namespace
}  // namespace frontmost::test
