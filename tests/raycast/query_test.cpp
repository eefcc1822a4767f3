// SPDX-License-Identifier: Apache-2.0
// Rays and segments: known answers, the rules at the ends, a comparison with every triangle one by one, and no leaks.

#include <gmock/gmock.h>

#include <algorithm>

#include "frontmost/raycast.h"
#include "indexed_scene.h"
#include "raycast/query/queries.h"
#include "support/odd_numbers.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

TEST(Query, MeetsTheNearestFloorAndCountsThemAll) {
  const Indexed of(floors({0, 1, 2, 3}));
  const RayHit down = closest_hit(of.index, Ray{{0.5f, -0.25f, 5}, {0, 0, -2}});
  EXPECT_EQ(down.primitive, 6u);
  EXPECT_EQ(down.t, 1.0);
  EXPECT_TRUE(down.is_front);
  const RayHit up = closest_hit(of.index, Ray{{0.5f, -0.25f, 1.5f}, {0, 0, 1}});
  EXPECT_EQ(up.primitive, 4u);
  EXPECT_EQ(up.t, 0.5);
  EXPECT_FALSE(up.is_front);
  const std::vector<RayHit> all = all_hits(of.index, Ray{{0.5f, -0.25f, 5}, {0, 0, -1}});
  ASSERT_EQ(all.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(all[i].t, 2.0 + double(i));
  EXPECT_FALSE(closest_hit(of.index, Ray{{1.5f, 0, 5}, {0, 0, -1}}));
  EXPECT_FALSE(closest_hit(of.index, Ray{{0.5f, -0.25f, -1}, {0, 0, -1}}));
}

TEST(Query, ARayThroughASharedEdgeMeetsBothAndNamesTheLower) {
  const Indexed of(floors({0}));
  EXPECT_EQ(closest_hit(of.index, Ray{{0.25f, 0.25f, 1}, {0, 0, -1}}).primitive, 0u);
  EXPECT_EQ(all_hits(of.index, Ray{{0.25f, 0.25f, 1}, {0, 0, -1}}).size(), 2u);
  // The floor's outer edge and its vertices belong to the floor too.
  EXPECT_TRUE(closest_hit(of.index, Ray{{1, 0.25f, 1}, {0, 0, -1}}));
  EXPECT_TRUE(closest_hit(of.index, Ray{{1, -1, 1}, {0, 0, -1}}));
  EXPECT_FALSE(closest_hit(of.index, Ray{{std::nextafter(1.0f, 2.0f), 0.25f, 1}, {0, 0, -1}}));
}

TEST(Query, WhatLiesAtAnEndDoesNotBlock) {
  const Indexed of(floors({0, 1}));
  const glm::vec3 low(0.5f, -0.25f, 0), high(0.5f, -0.25f, 1), above(0.5f, -0.25f, 2);
  EXPECT_TRUE(is_clear(of.index, {low, high}));
  EXPECT_TRUE(is_clear(of.index, {high, above}));
  EXPECT_FALSE(is_clear(of.index, {low, above}));
  const float just_above = std::nextafter(1.0f, 2.0f), just_below = std::nextafter(1.0f, 0.0f);
  EXPECT_FALSE(is_clear(of.index, {low, {0.5f, -0.25f, just_above}}));
  EXPECT_TRUE(is_clear(of.index, {low, {0.5f, -0.25f, just_below}}));
  EXPECT_EQ(closest_hit(of.index, Segment{low, above}).t, 0.5);
  // A ray starts behind its origin.
  EXPECT_EQ(closest_hit(of.index, Ray{high, {0, 0, -1}}).primitive, 0u);
  // A segment within a surface passes through nothing.
  EXPECT_TRUE(is_clear(of.index, {{-2, 0, 1}, {2, 0.5f, 1}}));
  EXPECT_FALSE(closest_hit(of.index, Ray{{-2, 0, 1}, {1, 0, 0}}));
}

TEST(Query, WhatIsTinyAgainstItsDistanceIsMetWhereItIs) {
  // A pole whose ring is as wide as sin(pi) in floats, below the rounding error of doubles from afar.
  Mesh mesh;
  add_triangle(mesh, {1.2e-17f, 0, 0}, {-1e-17f, 1e-18f, 1e-17f}, {-1e-17f, 0, -1e-17f});
  add_triangle(mesh, {-1, 0.5f, -1}, {0, 0.5f, 2}, {2, 0.5f, 0});
  const Indexed of(scene_of(mesh));
  const glm::vec3 origin(0.3f, 0.7f, 0.2f);
  const std::vector<RayHit> all = all_hits(of.index, Ray{origin, -origin});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].primitive, 1u);
  EXPECT_NEAR(all[1].t, 1, 1e-15);
  EXPECT_EQ(closest_hit(of.index, Ray{origin, -origin}).primitive, 1u);
  EXPECT_EQ(closest_hit(of.index, Segment{origin, -origin}).primitive, 1u);
}

TEST(Query, TheLengthOfADirectionSaysNothing) {
  Mesh mesh = random_mesh(Kind::soup, 2000, 3);
  for (glm::vec3& p : mesh.positions) p *= 0x1p-20f;
  const Indexed of(scene_of(mesh));
  Random random(4);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 origin = random.point(0x1p-20f), direction = random.point(1);
    const RayHit expected = closest_hit(of.index, Ray{origin, direction});
    met += bool(expected);
    // Lengths are powers of two: the same line, to the bit.
    for (const float length : {0x1p-100f, 0x1p-40f, 0x1p100f, 0x1p120f, 0x1p127f}) {
      const Ray ray{origin, direction * length};
      EXPECT_EQ(closest_hit(of.index, ray).primitive, expected.primitive) << length;
      EXPECT_EQ(closest_hit(of.index, ray).t * double(length), expected.t) << length;
    }
  }
  EXPECT_GT(met, 200);
}

TEST(Query, NonsenseMeetsNothing) {
  const Indexed of(floors({0})), empty{Scene{}};
  const glm::vec3 origin(0.5f, -0.25f, 1), down(0, 0, -1);
  for (const Ray& ray : {Ray{origin, glm::vec3(0)}, Ray{origin, {0, 0, kNan}}, Ray{origin, {0, 0, -kFloatInfinity}},
                         Ray{{kNan, 0, 0}, down}, Ray{{0, kFloatInfinity, 0}, down}}) {
    EXPECT_FALSE(closest_hit(of.index, ray));
    EXPECT_TRUE(all_hits(of.index, ray).empty());
  }
  for (const Segment& segment :
       {Segment{origin, origin}, Segment{origin, {kNan, 0, 0}}, Segment{{kFloatInfinity, 0, 0}, origin}})
    EXPECT_TRUE(is_clear(of.index, segment));
  EXPECT_FALSE(closest_hit(empty.index, Ray{origin, down}));
  EXPECT_TRUE(is_clear(empty.index, {origin, -origin}));
  // Tiny and huge directions are valid.
  EXPECT_EQ(closest_hit(of.index, Ray{origin, 1e-42f * down}).primitive, 0u);
  EXPECT_EQ(closest_hit(of.index, Ray{origin, 3e38f * down}).primitive, 0u);
  EXPECT_FALSE(is_clear(of.index, {{0.5f, -0.25f, 3e38f}, {0.5f, -0.25f, -3e38f}}));
  std::vector<RayHit> two(2);
  const Ray one_ray[] = {{origin, down}};
  EXPECT_THROW(closest_hits(of.index, one_ray, two), Error);
}

TEST(Query, AMillionCoincidentTriangles) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(1'000'000, {0, 1, 2});
  const Indexed of(scene_of(mesh));
  EXPECT_EQ(closest_hit(of.index, Ray{{0, 0, 1}, {0, 0, -1}}).primitive, 0u);
  EXPECT_FALSE(is_clear(of.index, {{0, 0, 1}, {0, 0, -1}}));
  EXPECT_EQ(all_hits(of.index, Ray{{0, 0, 1}, {0, 0, -1}}).size(), 1'000'000u);
  View view = frame(of.surfaces, 64, 64);
  const Visible seen = raycast(of.index, view);
  for (const PrimitiveId id : seen.primitives) EXPECT_TRUE(id == 0 || id == no_primitive);
}

class EveryKindOfQuery : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Query, EveryKindOfQuery, testing::ValuesIn(all_kinds));

/// A point of one of the triangles, or any point: queries along edges and through vertices are the hard ones.
glm::vec3 some_point(Random& random, const Surfaces& surfaces) {
  const std::array<glm::vec3, 3> c = surfaces.corners(PrimitiveId(random.below(int(surfaces.primitive_count()))));
  switch (random.below(4)) {
    case 0: return c[std::size_t(random.below(3))];
    case 1: return (c[0] + c[1]) * 0.5f;
    default: return random.point(1.5f);
  }
}

/// Compares every kind of query with a test of all triangles one by one. \returns whether anything is hit.
bool expect_each_triangle_asked(const Indexed& of, const raycast_detail::Query& query) {
  std::vector<RayHit> expected;
  for (PrimitiveId id = 0; id < of.surfaces.primitive_count(); ++id)
    if (const RayHit hit = raycast_detail::meet(query, of.surfaces.corners(id), id)) expected.push_back(hit);
  const auto order = [](const RayHit& a, const RayHit& b) {
    return a.t != b.t ? a.t < b.t : a.primitive < b.primitive;
  };
  std::sort(expected.begin(), expected.end(), order);
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    std::vector<RayHit> all, closest, any;
    walk(ray_tree(of.index), query, raycast_detail::Want::all, all, isa);
    walk(ray_tree(of.index), query, raycast_detail::Want::closest, closest, isa);
    walk(ray_tree(of.index), query, raycast_detail::Want::any, any, isa);
    std::sort(all.begin(), all.end(), order);
    EXPECT_EQ(all.size(), expected.size());
    for (std::size_t k = 0; k < std::min(all.size(), expected.size()); ++k) {
      EXPECT_EQ(all[k].primitive, expected[k].primitive);
      EXPECT_EQ(all[k].t, expected[k].t);
      EXPECT_EQ(all[k].is_front, expected[k].is_front);
    }
    EXPECT_EQ(any.empty(), expected.empty());
    EXPECT_EQ(closest.empty(), expected.empty());
    if (!expected.empty() && !closest.empty()) {
      EXPECT_EQ(closest[0].primitive, expected[0].primitive);
      EXPECT_EQ(closest[0].t, expected[0].t);
      EXPECT_EQ(closest[0].is_front, expected[0].is_front);
    }
  }
  return !expected.empty();
}

TEST_P(EveryKindOfQuery, EqualsEveryTriangleOneByOneOnEveryInstructionSet) {
  std::size_t met = 0;
  for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed) {
    Random random(seed + 40);
    const Indexed of(scene_of(random_mesh(GetParam(), 100 + random.below(300), seed)));
    for (int i = 0; i < 60 && !HasFailure(); ++i) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", query " << i);
      const glm::vec3 from = some_point(random, of.surfaces), to = some_point(random, of.surfaces);
      const raycast_detail::Query query{from, to, to - from, i % 2 == 0};
      if (raycast_detail::is_valid(query)) met += expect_each_triangle_asked(of, query);
    }
  }
  if (GetParam() != Kind::tiny && GetParam() != Kind::slivers) {
    EXPECT_GT(met, 20u);
  }
}

TEST_P(EveryKindOfQuery, TakesTheSameStepsOnEveryInstructionSet) {
  Random random(60);
  const Indexed of(scene_of(random_mesh(GetParam(), 1000, 12)));
  std::vector<raycast_detail::Query> queries(400);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const glm::vec3 from = some_point(random, of.surfaces), to = some_point(random, of.surfaces);
    queries[i] = {from, to, to - from, i % 2 == 0, i % 4 < 2};
  }
  for (const raycast_detail::Want want : {raycast_detail::Want::closest, raycast_detail::Want::any}) {
    std::vector<RayHit> expected(queries.size()), hits(queries.size());
    const std::uint64_t steps = walk_batch(ray_tree(of.index), queries, want, expected, Isa::scalar);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(name(isa));
      EXPECT_EQ(walk_batch(ray_tree(of.index), queries, want, hits, isa), steps);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(hits[i].primitive, expected[i].primitive) << i;
        ASSERT_EQ(hits[i].t, expected[i].t) << i;
      }
    }
  }
}

/// One-way segments and cutouts need every hit looked at before it counts.
TEST(Query, AnyHitEndsAOneWaySegment) {
  Mesh mesh;
  for (int i = 0; i < 4000; ++i) {
    const float z = float(i);
    add_triangle(mesh, {-1, -1, z}, {1, -1, z}, {0, 1, z});
  }
  const Indexed of(scene_of(mesh));
  const raycast_detail::Query down{{0, 0, 5000}, {0, 0, -1}, {0, 0, -5001}, true, true};
  RayHit hit;
  EXPECT_LT(walk_batch(ray_tree(of.index), {&down, 1}, raycast_detail::Want::any, {&hit, 1}, Isa::best), 10u);
  EXPECT_TRUE(hit);
  // The segment goes on through the triangles that it meets from behind.
  const raycast_detail::Query up{{0, 0, -1}, {0, 0, 5000}, {0, 0, 5001}, true, true};
  walk_batch(ray_tree(of.index), {&up, 1}, raycast_detail::Want::any, {&hit, 1}, Isa::best);
  EXPECT_FALSE(hit);
}

/// The area of every box is zero, and the areas' heuristic cuts off one leaf after the other.
TEST(Query, LeavesAtShrinkingDistancesMakeNoDeepTree) {
  Mesh mesh;
  std::vector<float> places;
  for (float x = -1; x < -0x1p-110f; x *= 0.93f) {
    places.push_back(x);
    for (int i = 1; i <= 8; ++i)
      add_triangle(mesh, {x, 0, 0}, {x * (1 + 0x1p-12f * float(i)), 0, 0}, {x, 0x1p-149f, 0});
  }
  const Indexed of(scene_of(mesh));
  EXPECT_GT(places.size(), 1000u);
  EXPECT_LT(ray_tree(of.index).depth, 80u);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(closest_hit(of.index, Ray{{places[i], 0, 1}, {0, 0, -1}}).primitive, 8 * i) << i;
}

/// Products of coordinates overflow at one scale and underflow at another.
TEST(Query, EqualsEveryTriangleOneByOneAtEveryScale) {
  for (const float scale : {1e-30f, 1e-20f, 1e-13f, 1e-6f, 1e6f, 1e13f, 1e20f, 1e30f}) {
    std::size_t met = 0;
    for (std::uint64_t seed = 0; seed < 3 && !HasFailure(); ++seed) {
      Random random(seed + 70);
      Mesh mesh = random_mesh(seed == 0 ? Kind::soup : seed == 1 ? Kind::sheets : Kind::fan, 150, seed);
      for (glm::vec3& p : mesh.positions) p *= scale;
      const Indexed of(scene_of(mesh));
      for (int i = 0; i < 40 && !HasFailure(); ++i) {
        SCOPED_TRACE(testing::Message() << "scale " << scale << ", seed " << seed << ", query " << i);
        const glm::vec3 from = scale * random.point(1.5f), to = scale * random.point(1.5f);
        // Rays have any length, too.
        const glm::vec3 direction = i % 4 == 1 ? (to - from) / scale : to - from;
        met += expect_each_triangle_asked(of, {from, to, direction, i % 2 == 0});
      }
    }
    EXPECT_GT(met, 20u);
  }
}

/// A closed ball with bumps and shared vertices.
Mesh bumpy_ball(int rings, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  const int columns = 2 * rings;
  mesh.positions.push_back({0, 0, 1});
  for (int j = 1; j < rings; ++j)
    for (int i = 0; i < columns; ++i) {
      const float a = 3.14159265f * float(j) / float(rings), b = 6.2831853f * float(i) / float(columns);
      mesh.positions.push_back(random.within(0.8f, 1.2f) *
                               glm::vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  mesh.positions.push_back({0, 0, -1});
  const auto at = [&](int j, int i) { return std::uint32_t(1 + (j - 1) * columns + i % columns); };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  for (int i = 0; i < columns; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    mesh.triangles.push_back({last, at(rings - 1, i + 1), at(rings - 1, i)});
    for (int j = 1; j + 1 < rings; ++j) {
      mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return mesh;
}

TEST(Query, NothingLeaksOutOfAClosedSurface) {
  const Mesh mesh = bumpy_ball(40, 5);
  const Indexed of(scene_of(mesh));
  Random random(77);
  std::size_t asked = 0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::vec3 inside = random.point(0.3f);
    const glm::vec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y], c = mesh.positions[triangle.z];
    for (const glm::vec3& aim : {a, (a + b) * 0.5f, a + (c - a) * random.unit(), (a + b + c) / 3.0f}) {
      ASSERT_TRUE(closest_hit(of.index, Ray{inside, aim - inside})) << aim.x << " " << aim.y << " " << aim.z;
      ASSERT_FALSE(is_clear(of.index, {inside, inside + (aim - inside) * 3.0f}));
      asked += 2;
    }
  }
  EXPECT_GT(asked, 20'000u);
}

TEST(Query, TheLineOfSightIsMutual) {
  const Indexed of(scene_of(random_mesh(Kind::shared_grid, 800, 3)));
  Random random(4);
  std::size_t clear = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::vec3 a = some_point(random, of.surfaces), b = some_point(random, of.surfaces);
    ASSERT_EQ(is_clear(of.index, {a, b}), is_clear(of.index, {b, a})) << i;
    clear += is_clear(of.index, {a, b});
  }
  EXPECT_GT(clear, 1'000u);
  EXPECT_LT(clear, 19'000u);
}

TEST(Query, BatchesDoNotDependOnThreads) {
  const Indexed of(scene_of(random_mesh(Kind::soup, 3000, 9)));
  Random random(6);
  std::vector<Ray> rays(5000);
  std::vector<Segment> segments(5000);
  for (Ray& ray : rays) ray = {random.point(2), random.point(1)};
  for (Segment& segment : segments) segment = {random.point(2), random.point(2)};
  std::vector<RayHit> hits(5000), again(5000), between(5000);
  std::vector<std::uint8_t> clear(5000);
  closest_hits(of.index, rays, hits, {.threads = 1});
  closest_hits(of.index, rays, again, {.threads = 3, .isa = Isa::scalar});
  closest_hits(of.index, segments, between);
  are_clear(of.index, segments, clear);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(hits[i].primitive, again[i].primitive);
    ASSERT_EQ(hits[i].t, again[i].t);
    ASSERT_EQ(hits[i].primitive, closest_hit(of.index, rays[i]).primitive);
    ASSERT_EQ(bool(clear[i]), !between[i]);
  }
}

/// The tree is so large that the rays of a batch take turns; some of the rays are invalid.
TEST(Query, BatchesOfLargeTreesEqualSingleRays) {
  const Indexed of(scene_of(random_mesh(Kind::tiny, 250'000, 10)));
  ASSERT_GT(of.index.byte_count(), std::size_t(8) << 20);
  Random random(11);
  std::vector<Ray> rays(1500);
  std::vector<Segment> segments(1500);
  for (Ray& ray : rays) ray = {random.point(1), random.point(1)};
  for (Segment& segment : segments) segment = {random.point(1), random.point(1)};
  for (std::size_t i = 0; i < rays.size(); i += 7) rays[i].direction = glm::vec3(0);
  std::vector<RayHit> hits(rays.size());
  std::vector<std::uint8_t> clear(segments.size());
  closest_hits(of.index, rays, hits);
  are_clear(of.index, segments, clear);
  std::size_t met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<RayHit> one, any;
    const raycast_detail::Query ray{rays[i].origin, rays[i].origin, rays[i].direction, false};
    if (raycast_detail::is_valid(ray)) walk(ray_tree(of.index), ray, raycast_detail::Want::closest, one, Isa::best);
    ASSERT_EQ(hits[i].primitive, one.empty() ? no_primitive : one[0].primitive);
    ASSERT_EQ(hits[i].t, one.empty() ? RayHit{}.t : one[0].t);
    const Segment& s = segments[i];
    walk(ray_tree(of.index), {s.from, s.to, s.to - s.from, true}, raycast_detail::Want::any, any, Isa::best);
    ASSERT_EQ(bool(clear[i]), any.empty());
    met += !one.empty();
  }
  EXPECT_GT(met, 500u);
}

}  // namespace
}  // namespace frontmost::test
