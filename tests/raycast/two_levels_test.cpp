// SPDX-License-Identifier: Apache-2.0
// An index on two levels against one over all triangles: the same answers to the bit.
#include <gtest/gtest.h>

#include "frontmost/raycast.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// Instances of two meshes, as they are and moved, mirrored, sheared, flattened.
Scene many_of(Kind kind, std::uint64_t seed) {
  Scene scene = scene_of(random_mesh(kind, 300, seed));
  scene.meshes.push_back(random_mesh(Kind::shared_grid, 200, seed + 1));
  scene.meshes.push_back({});  // of nothing
  const auto add = [&](std::uint32_t mesh, const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z,
                       const glm::dvec4& offset) {
    scene.instances.push_back({"", mesh, glm::dmat4(x, y, z, offset)});
  };
  add(1, {-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.3, 0.2, 0.1, 1});
  add(0, {0.5, 0, 0, 0}, {0, 0, 0.5, 0}, {0, -0.5, 0, 0}, {0, 0.5, 0, 1});
  add(2, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
  add(0, {0.7, 0.3, 0.1, 0}, {-0.2, 0.6, 0.4, 0}, {0.1, -0.5, 0.8, 0}, {-0.4, 0.1, 0.7, 1});
  add(1, {0.3, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0.3, 0}, {0.1, 0.4, 0, 1});
  add(0, {0.1, 0, 0, 0}, {0.3, -0.1, 0, 0}, {0, 0, 0.2, 0}, {1000.25, 0, 0, 1});
  return scene;
}

std::vector<Segment> random_segments(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Segment> segments(count);
  for (Segment& s : segments) {
    s.from = random.point(1.5f);
    s.to = random.point(1.5f);
  }
  return segments;
}

std::vector<TrianglePoint> random_points(const Surfaces& surfaces, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<TrianglePoint> points(count);
  for (TrianglePoint& point : points) {
    point.primitive = PrimitiveId(random.below(int(surfaces.primitive_count())));
    point.corners = surfaces.corners(point.primitive);
    const float a = random.unit();
    point.weights = {a, 1 - a, random.unit()};
  }
  return points;
}

void expect_same_hit(const RayHit& a, const RayHit& b) {
  ASSERT_EQ(a.primitive, b.primitive);
  ASSERT_EQ(a.t, b.t);
  ASSERT_EQ(a.is_front, b.is_front);
}

void expect_as_one_level(const RayIndex& index, const Surfaces& surfaces, std::uint64_t seed,
                         const Execution& execution = {}) {
  const RayIndex flat(surfaces);
  EXPECT_EQ(index.triangle_count() == 0, flat.triangle_count() == 0);
  Random random(seed);
  View view = random_view(random, 90, 70);
  EXPECT_EQ(content_hash(raycast(index, view, execution)), content_hash(raycast(flat, view)));

  const std::vector<Segment> segments = random_segments(seed, 100);
  std::vector<RayHit> hits(segments.size()), flat_hits(segments.size());
  std::vector<std::uint8_t> clear(segments.size()), flat_clear(segments.size());
  closest_hits(index, segments, hits, execution);
  closest_hits(flat, segments, flat_hits);
  are_clear(index, segments, clear, execution);
  are_clear(flat, segments, flat_clear);
  EXPECT_EQ(clear, flat_clear);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    SCOPED_TRACE(i);
    expect_same_hit(hits[i], flat_hits[i]);
    if (i >= 5) continue;
    const Ray ray{segments[i].from, segments[i].to - segments[i].from};
    const std::vector<RayHit> all = all_hits(index, ray), flat_all = all_hits(flat, ray);
    ASSERT_EQ(all.size(), flat_all.size());
    for (std::size_t k = 0; k < all.size(); ++k) expect_same_hit(all[k], flat_all[k]);
  }
  if (surfaces.primitive_count() == 0) return;
  const std::vector<TrianglePoint> points = random_points(surfaces, seed, 40);
  std::vector<std::uint8_t> lit(points.size()), flat_lit(points.size());
  const glm::vec3 to_light = random.point(1);
  are_lit(index, points, to_light, lit, execution);
  are_lit(flat, points, to_light, flat_lit);
  EXPECT_EQ(lit, flat_lit);
}

TEST(TwoLevels, AnswerAsOneLevelForEveryKind) {
  for (const Kind kind : all_kinds) {
    SCOPED_TRACE(int(kind));
    for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
      const Scene scene = many_of(kind, seed);
      expect_as_one_level(RayIndex(scene), Surfaces(scene), seed);
    }
  }
}

TEST(TwoLevels, ThreadsAndInstructionSetsChangeNothing) {
  const Scene scene = many_of(Kind::soup, 7);
  const Surfaces surfaces(scene);
  for (const Isa isa : available_isas())
    for (const int threads : {1, 3}) {
      SCOPED_TRACE(name(isa));
      const Execution execution{.threads = threads, .isa = isa};
      expect_as_one_level(RayIndex(scene, execution), surfaces, 4, execution);
    }
}

TEST(TwoLevels, FollowTheInstances) {
  Scene scene = many_of(Kind::soup, 3);
  RayIndex index(scene);
  for (std::uint64_t step = 0; step < 4; ++step) {
    scene.instances[step].world_from_mesh[3] += glm::dvec4(0.1, -0.2, 0.05, 0);
    scene.instances[step].world_from_mesh[step % 3] *= -1.5;
    index.refit(scene);
    expect_as_one_level(index, Surfaces(scene), step);
  }
}

TEST(TwoLevels, OtherInstancesMakeANewIndex) {
  Scene scene = many_of(Kind::soup, 3);
  RayIndex index(scene);
  const auto expect_followed = [&](const char* what) {
    SCOPED_TRACE(what);
    index.refit(scene);
    expect_as_one_level(index, Surfaces(scene), 2);
  };
  scene.instances.pop_back();
  expect_followed("an instance less");
  std::swap(scene.instances[0], scene.instances[1]);
  expect_followed("another order");
  add_triangle(scene.meshes[0], {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_followed("a triangle more");
  scene.instances[0].mesh = 2;
  expect_followed("an instance of nothing");
  scene.instances.clear();
  expect_followed("nothing");
  scene = many_of(Kind::fan, 1);
  expect_followed("something");
  index.refit(Surfaces(scene));
  expect_as_one_level(index, Surfaces(scene), 3);
  index.refit(scene);
  expect_as_one_level(index, Surfaces(scene), 3);
}

TEST(TwoLevels, GrowByAMatrixAnInstance) {
  Scene scene = scene_of(random_mesh(Kind::tiny, 20000, 1));
  const std::size_t one = RayIndex(scene).byte_count();
  EXPECT_LT(one, RayIndex(Surfaces(scene)).byte_count() + 2000);
  Random random(5);
  for (int i = 1; i < 1000; ++i) {
    glm::dmat4 there(1.0);
    for (int axis = 0; axis < 3; ++axis) there[3][axis] = random.within(-30, 30);
    scene.instances.push_back({"", 0, there});
  }
  const RayIndex index(scene);  // 20 million triangles
  EXPECT_EQ(index.triangle_count() % 1000, 0u);
  EXPECT_GT(index.triangle_count(), 19'000'000u);
  EXPECT_LT(index.byte_count(), one + 1000 * 400);
}

TEST(TwoLevels, SurviveWhatFloatsDoNotHold) {
  constexpr double huge = 3e38, tiny = 1e-300;
  for (const double scale : {huge, 1e308, 1e30, tiny, 1e-46, 0.0}) {
    SCOPED_TRACE(scale);
    Scene scene = many_of(scale == 1e30 ? Kind::huge : Kind::soup, 9);
    for (int axis = 0; axis < 3; ++axis) scene.instances[3].world_from_mesh[axis] *= scale;
    scene.instances[4].world_from_mesh[3] = {scale, -scale, 0.1, 1};
    expect_as_one_level(RayIndex(scene), Surfaces(scene), 11);
  }
}

TEST(TwoLevels, CornersThatAreNotFinite) {
  Scene scene = many_of(Kind::soup, 2);
  scene.meshes[0].positions[3].y = std::numeric_limits<float>::quiet_NaN();
  scene.meshes[0].positions[100].x = std::numeric_limits<float>::infinity();
  expect_as_one_level(RayIndex(scene), Surfaces(scene), 1);
}

TEST(TwoLevels, BadScenesAreRefused) {
  Scene scene = many_of(Kind::soup, 2);
  scene.instances[2].world_from_mesh[1][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RayIndex{scene}, Error);
  scene.instances[2].world_from_mesh[1][0] = 0;
  RayIndex index(scene);
  scene.instances[2].world_from_mesh[1][0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(index.refit(scene), Error);
  scene.instances[2] = {};
  scene.meshes[0].triangles[5].z = 1u << 30;
  EXPECT_THROW(RayIndex{scene}, Error);
}

}  // namespace
}  // namespace frontmost::test
