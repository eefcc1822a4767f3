// SPDX-License-Identifier: Apache-2.0
// A refitted index against a new one: the same answers to the bit, wherever the triangles have moved.
#include <gtest/gtest.h>

#include <atomic>

#include "frontmost/raycast.h"
#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// Three instances of one mesh, one of them mirrored.
Scene three_of(Kind kind, std::uint64_t seed) {
  Scene scene = scene_of(random_mesh(kind, 400, seed));
  scene.instances.push_back({"mirrored", 0, glm::dmat4({-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.3, 0.2, 0.1, 1})});
  scene.instances.push_back({"small", 0, glm::dmat4({0.5, 0, 0, 0}, {0, 0, 0.5, 0}, {0, -0.5, 0, 0}, {0, 0.5, 0, 1})});
  return scene;
}

void expect_as_built_anew(const RayIndex& index, const RayIndex& anew, std::uint64_t seed) {
  EXPECT_EQ(index.triangle_count(), anew.triangle_count());
  EXPECT_EQ(index.bounds().low, anew.bounds().low);
  EXPECT_EQ(index.bounds().high, anew.bounds().high);
  Random random(seed);
  const View view = random_view(random, 90, 70);
  EXPECT_EQ(content_hash(raycast(index, view)), content_hash(raycast(anew, view)));
  std::vector<Segment> segments(300);
  for (Segment& s : segments) {
    s.from = random.point(1.5f);
    s.to = random.point(1.5f);
  }
  std::vector<RayHit> hits(segments.size()), hits_anew(segments.size());
  closest_hits(index, segments, hits);
  closest_hits(anew, segments, hits_anew);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ASSERT_EQ(hits[i].primitive, hits_anew[i].primitive) << i;
    ASSERT_EQ(hits[i].t, hits_anew[i].t) << i;
  }
}

void expect_as_built_anew(const RayIndex& index, const Surfaces& surfaces, std::uint64_t seed) {
  expect_as_built_anew(index, RayIndex(surfaces), seed);
}

TEST(Refit, AnswersEqualThoseOfANewIndex) {
  for (const Kind kind : all_kinds) {
    SCOPED_TRACE(int(kind));
    Scene scene = three_of(kind, 3);
    RayIndex index{Surfaces(scene)};
    for (std::uint64_t step = 0; step < 3; ++step) {
      Random random(step + 17);
      for (glm::vec3& p : scene.meshes[0].positions) p += random.point(step == 2 ? 1.0f : 0.1f);
      scene.instances[step].world_from_mesh[3] += glm::dvec4(0.1, -0.2, 0.05, 0);
      const Surfaces surfaces(scene);
      index.refit(surfaces, {.threads = 1 + int(step)});
      expect_as_built_anew(index, surfaces, step);
    }
  }
}

TEST(Refit, KeepsItsMemoryAndGoesBack) {
  Scene scene = three_of(Kind::soup, 5);
  const Surfaces before(scene);
  RayIndex index(before);
  const std::size_t bytes = index.byte_count();
  scene.instances[1].world_from_mesh[3] = {100, 0, 0, 1};
  index.refit(Surfaces(scene));
  EXPECT_GT(index.bounds().high.x, 98);
  scene.instances[1].world_from_mesh[3] = {0.3, 0.2, 0.1, 1};
  const Surfaces again(scene);
  index.refit(again);
  EXPECT_EQ(index.byte_count(), bytes);
  expect_as_built_anew(index, again, 1);
}

TEST(Refit, OtherTrianglesMakeANewIndex) {
  Scene scene = three_of(Kind::soup, 5);
  RayIndex index{Surfaces(scene)};
  const auto expect_followed = [&](const char* what) {
    SCOPED_TRACE(what);
    const Surfaces surfaces(scene);
    index.refit(surfaces);
    expect_as_built_anew(index, surfaces, 2);
  };
  scene.instances.pop_back();
  expect_followed("an instance less");
  add_triangle(scene.meshes[0], {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_followed("a triangle more");
  const glm::vec3 there = scene.meshes[0].positions[7];
  scene.meshes[0].positions[7].y = std::numeric_limits<float>::quiet_NaN();
  expect_followed("a corner is not a number");
  scene.meshes[0].positions[7] = there;
  expect_followed("and is one again");
  scene.meshes[0].triangles[2].y = scene.meshes[0].triangles[2].x;
  expect_followed("a corner twice");
  std::swap(scene.meshes[0].triangles[2], scene.meshes[0].triangles[3]);
  expect_followed("another one has it");
  scene.instances.clear();
  expect_followed("nothing");
  scene = three_of(Kind::fan, 1);
  expect_followed("something");
}

/// Asks the index every kind of query: a leftover of an earlier scene would be hit.
void expect_empty(const RayIndex& index) {
  EXPECT_EQ(index.triangle_count(), 0u);
  EXPECT_TRUE(index.bounds().is_empty());
  EXPECT_FALSE(closest_hit(index, Ray{{0, 0, 5}, {0, 0, -1}}));
  EXPECT_TRUE(is_clear(index, {{0, 0, 5}, {0, 0, -5}}));
  Random random(1);
  const Visible seen = raycast(index, random_view(random, 60, 40));
  EXPECT_EQ(covered(seen), 0u);
}

TEST(Refit, OneThatIsEndedHalfwayLeavesNothing) {
  // The new scene has fewer triangles with holes: ids of old ones would be beyond the new table.
  const Scene many = cutout_scene(random_mesh(Kind::soup, 4000, 1), Cut::all, 0.5f, 1);
  const Scene few = cutout_scene(random_mesh(Kind::soup, 40, 2), Cut::all, 0.5f, 2);
  const Surfaces before(many), after(few);
  bool was_ended = false, was_whole = false;
  for (std::size_t last = 1; last <= 40 && !was_whole; ++last) {
    RayIndex index(before);
    const CountingWatch watch(last);
    try {
      index.refit(after, watch.execution());
      was_whole = true;
      expect_as_built_anew(index, after, 7);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
      was_ended = true;
      expect_empty(index);
      index.refit(after);
      expect_as_built_anew(index, after, 7);
    }
  }
  EXPECT_TRUE(was_ended);
  EXPECT_TRUE(was_whole);
}

}  // namespace
}  // namespace frontmost::test
