// SPDX-License-Identifier: Apache-2.0
// One triangle thousands of times: rays hit the first copy, whatever the order of the leaves.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "indexed_scene.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

TEST(Repeats, RaysMeetTheFirst) {
  Mesh mesh;
  const int count = tries_little ? 500 : 20'000;
  for (int i = 0; i < count; ++i) {
    add_triangle(mesh, {-9, -9, 0}, {9, -9, 0.1f}, {0, 9, 0});
    add_triangle(mesh, {-9, -9, -1}, {9, -9, 1}, {0, 9, 0.1f});
  }
  // A triangle behind both, so that the pair hides something.
  add_triangle(mesh, {-90, -90, -2}, {90, -90, -2}, {0, 90, -2});
  const Indexed in(scene_of(std::move(mesh)));
  View view;
  view.width = 300, view.height = 200;
  view.world_from_eye = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.9, 1.5, {0.1, 10});
  const Visible seen = raycast(in.index, view);
  bool both = false;
  for (const PrimitiveId id : seen.primitives) {
    ASSERT_LT(id, 2u);
    both = both || id != seen.primitives[0];
  }
  EXPECT_TRUE(both);
}

/// A leaning triangle and one across it, `count` times; half of the time the second one comes first.
Scene copies_of_two(int count) {
  Mesh mesh;
  const auto first = [&] { add_triangle(mesh, {-9, -9, 0}, {9, -9, 0.1f}, {0, 9, 0}); };
  const auto second = [&] { add_triangle(mesh, {-3, -9, -1}, {9, -2, 1}, {0, 9, 0.1f}); };
  for (int i = 0; i < count; ++i) {
    i % 2 == 0 ? first() : second();
    i % 2 == 0 ? second() : first();
  }
  return scene_of(std::move(mesh));
}

// If every tile tested every copy, a million of them would take minutes.
TEST(Repeats, AMillionCostLikeOne) {
  const int count = tries_little ? 5'000 : 500'000;
  const Indexed one(copies_of_two(1)), many(copies_of_two(count));
  EXPECT_EQ(many.index.triangle_count(), std::uint32_t(2 * count));
  View view;
  view.width = 640, view.height = 400;
  view.world_from_eye = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.9, 1.6, {0.1, 10});
  for (const Culling culling : {Culling::none, Culling::back}) {
    view.culling = culling;
    const Visible wanted = raycast(one.index, view), found = raycast(many.index, view);
    EXPECT_TRUE(std::equal(wanted.primitives.begin(), wanted.primitives.end(), found.primitives.begin()));
    EXPECT_TRUE(std::equal(wanted.keys.begin(), wanted.keys.end(), found.keys.begin()));
  }
  for (const float x : {-1.0f, 0.0f, 0.5f, 2.0f}) {
    const Ray ray{{x, 0, 5}, {0, 0.01f, -1}};
    EXPECT_EQ(closest_hit(many.index, ray).primitive, closest_hit(one.index, ray).primitive) << x;
    EXPECT_EQ(closest_hit(many.index, ray).t, closest_hit(one.index, ray).t) << x;
    // A query for all hits gets all copies.
    const std::vector<RayHit> few = all_hits(one.index, ray), all = all_hits(many.index, ray);
    ASSERT_EQ(all.size(), few.size() * std::size_t(count)) << x;
    std::set<PrimitiveId> ids;
    for (const RayHit& hit : all) ids.insert(hit.primitive);
    EXPECT_EQ(ids.size(), all.size()) << "each once";
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const RayHit& a, const RayHit& b) { return a.t < b.t; }));
    for (const glm::vec3 to : {glm::vec3(x, 0, -5), glm::vec3(x, 0, 4), glm::vec3(50, 0, 5)})
      EXPECT_EQ(is_clear(many.index, {{x, 0, 5}, to}), is_clear(one.index, {{x, 0, 5}, to})) << x;
  }
}

TEST(Repeats, CopiesThatMoveApartAreFollowed) {
  Scene scene;
  scene.meshes.emplace_back();
  add_triangle(scene.meshes[0], {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  for (int i = 0; i < 10'000; ++i) scene.instances.push_back({"", 0, glm::dmat4(1)});
  RayIndex index{Surfaces(scene)};
  const Ray ray{{0, 0, 1e6f}, {0, 0, -1}};
  EXPECT_EQ(closest_hit(index, ray).primitive, 0u);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].world_from_mesh[3].z = double(i);
  index.refit(Surfaces(scene));
  EXPECT_EQ(closest_hit(index, ray).primitive, 9'999u);
  EXPECT_EQ(index.triangle_count(), 10'000u);
  for (Instance& instance : scene.instances) instance.world_from_mesh[3].z = 7;
  index.refit(Surfaces(scene));
  EXPECT_EQ(closest_hit(index, ray).primitive, 0u);
  EXPECT_EQ(all_hits(index, ray).size(), 10'000u);
}

}  // namespace
}  // namespace frontmost::test
