// SPDX-License-Identifier: Apache-2.0
// Eyes inside the scene: triangles cross the near plane, reach behind the eye, and run from one's feet to the horizon.
#include <gtest/gtest.h>

#include <cstdlib>

#include "frontmost/abuffer.h"
#include "frontmost/files.h"
#include "frontmost/precision.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// Number of eyes; the variable FRONTMOST_EYES can raise it to thousands.
std::uint64_t eyes(std::uint64_t count) {
  const char* const wanted = std::getenv("FRONTMOST_EYES");
  return wanted ? std::strtoull(wanted, nullptr, 10) : seeds(count);
}

/// A view from a random point of the box in a random direction, 90 or 120 degrees wide. Its planes are fitted as by the
/// command line.
View eye_within(const Box& box, Random& random, std::uint64_t number) {
  const glm::dvec3 low(box.low), size = glm::dvec3(box.high) - low;
  const double x = random.unit(), y = random.unit(), z = random.unit();
  const glm::dvec3 eye = low + glm::dvec3(x, y, z) * size;
  View view;
  view.width = 120;
  view.height = 90;
  const glm::dvec3 to(random.point(1));
  view.world_from_eye = look_at(eye, eye + to + glm::dvec3(0, 0, 1e-3), {0.1, 1, 0.2});
  const double far = 1.01 * glm::length(size);
  view.projection = make_projection(glm::radians(number % 2 ? 90.0 : 120.0), 120.0 / 90, {far / 10000, far});
  return view;
}

struct Counts {
  std::uint64_t rays = 0, layers = 0, covered = 0;
};

Counts unexplained(const Surfaces& surfaces, std::uint64_t count, std::uint64_t seed) {
  Random random(seed);
  const RayIndex index(surfaces);
  Counts counts;
  for (std::uint64_t i = 0; i < count; ++i) {
    const View view = eye_within(surfaces.bounds(), random, i);
    const Visible seen = zbuffer(surfaces, view);
    const std::uint64_t by_rays = check_agreement(surfaces, seen, raycast(index, view)).count(Difference::unexplained);
    const std::uint64_t by_layers =
        check_agreement(surfaces, seen, visible_layers(surfaces, view, 1)[0]).count(Difference::unexplained);
    EXPECT_EQ(by_rays, 0u) << "eye " << i;
    EXPECT_EQ(by_layers, 0u) << "eye " << i;
    counts.rays += by_rays;
    counts.layers += by_layers;
    counts.covered += std::uint64_t(std::count_if(seen.keys.begin(), seen.keys.end(), [](float k) { return k > 0; }));
  }
  return counts;
}

class EyesInBuiltin : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Inside, EyesInBuiltin, testing::Values("city", "gallery", "cubes", "teapot", "cycle"));

TEST_P(EyesInBuiltin, EveryMethodSeesTheSame) {
  const Scene scene = builtin(GetParam());
  EXPECT_GT(unexplained(Surfaces(scene), eyes(12), 1).covered, tries_little ? 400u : 1000u);
}

class EyesInEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Inside, EyesInEveryKind, testing::ValuesIn(all_kinds));

TEST_P(EyesInEveryKind, EveryMethodSeesTheSame) {
  std::uint64_t covered = 0;
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    const Scene scene = scene_of(random_mesh(GetParam(), 200, seed));
    covered += unexplained(Surfaces(scene), 8, seed).covered;
  }
  EXPECT_GT(covered, 0u);
}

class EyesInModel : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Inside, EyesInModel,
                         testing::Values("scenes/city.glb", "scenes/home-theater.glb", "scenes/occlusion-room.glb",
                                         "scenes/pandora.obj", "scenes/sponza.glb", "scenes/warehouse.glb",
                                         "assembly/2-cylinder-engine.glb", "assembly/as1.glb",
                                         "assembly/cesium-milk-truck.glb", "assembly/toy-car.glb"));

TEST_P(EyesInModel, EveryMethodSeesTheSame) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(model(GetParam()));
  const Surfaces surfaces(scene);
  const std::uint64_t least = surfaces.primitive_count() > 200000 ? 3 : 10;
  EXPECT_GT(unexplained(surfaces, eyes(least), 2).covered, 1000u);
}

/// The mesh, and behind it all of its triangles again, with vertices rotated or reversed.
Mesh given_again(Mesh mesh, Random& random) {
  constexpr std::array<glm::ivec3, 5> kOrders{{{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const glm::ivec3 order = kOrders[std::size_t(random.below(5))];
    mesh.triangles.push_back({t[order.x], t[order.y], t[order.z]});
  }
  return mesh;
}

class FacesGivenTwice : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Inside, FacesGivenTwice, testing::ValuesIn(all_kinds));

TEST_P(FacesGivenTwice, ShowTheFirst) {
  std::size_t covered = 0;
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    Random random(seed + 900);
    const Mesh once = random_mesh(GetParam(), 300, seed);
    const auto count = PrimitiveId(once.triangles.size());
    const Scene scene = scene_of(given_again(once, random));
    const Surfaces surfaces(scene);
    const auto expect_first = [&](const Visible& visible) {
      for (const PrimitiveId id : visible.primitives) {
        ASSERT_TRUE(id < count || id == no_primitive) << "seed " << seed;
        covered += id != no_primitive;
      }
    };
    for (const View& view : {random_view(random, 120, 90), eye_within(surfaces.bounds(), random, seed)}) {
      expect_first(draw_both_ways(surfaces, view));
      expect_first(visible_layers(surfaces, view, 1)[0]);
      expect_first(raycast(surfaces, view));
    }
  }
  EXPECT_GT(covered, 0u);
}

// The eye of the documentation, in the street, where depths are hard to get right, for the A-buffer too.
TEST(EyesInside, TheStreetOfTheCity) {
  const Scene scene = builtin("city");
  const Surfaces surfaces(scene);
  View view;
  view.width = 640;
  view.height = 360;
  view.world_from_eye = look_at({8, 3, 25}, {9, 3, 25}, {0, 1, 0});
  view.projection = make_projection(glm::radians(30.0), 640.0 / 360, {0.02, 200});
  const Visible seen = zbuffer(surfaces, view);
  EXPECT_EQ(check_agreement(surfaces, seen, raycast(surfaces, view)).count(Difference::unexplained), 0u);
  EXPECT_EQ(check_agreement(surfaces, seen, visible_layers(surfaces, view, 1)[0]).count(Difference::unexplained), 0u);
}

}  // namespace
}  // namespace frontmost::test
