// SPDX-License-Identifier: Apache-2.0
// Laws that queries obey for any scene, without an oracle, and the error messages of refused queries.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/raycast.h"
#include "indexed_scene.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

class EveryKindOfLaw : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(RayCast, EveryKindOfLaw, testing::ValuesIn(all_kinds));

Scene law_scene(Kind kind, std::uint64_t seed) {
  Random random(seed + 40);
  const int count = 30 + random.below(120);
  return scene_of(random_mesh(kind, count, seed));
}

glm::vec3 lattice_point(Random& random) {
  const int x = random.below(65) - 32, y = random.below(65) - 32, z = random.below(65) - 32;
  return glm::vec3(x, y, z) / 16.0f;
}

/// A segment with ends on a lattice, so that differences are exact and some ends lie on triangles.
Segment law_segment(Random& random) {
  const glm::vec3 from = lattice_point(random), to = lattice_point(random);
  return {from, to};
}

/// Excludes kinds too small, too thin or too far apart to be hit by random queries.
bool is_met_often(Kind kind) { return kind != Kind::tiny && kind != Kind::slivers && kind != Kind::huge; }

std::vector<PrimitiveId> ids_of(const std::vector<RayHit>& hits) {
  std::vector<PrimitiveId> ids;
  for (const RayHit& hit : hits) ids.push_back(hit.primitive);
  std::sort(ids.begin(), ids.end());
  return ids;
}

TEST_P(EveryKindOfLaw, SegmentsAreTheBeginningsOfRays) {
  std::size_t met = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    const Scene scene = law_scene(GetParam(), seed);
    const RayIndex index{Surfaces(scene)};
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      const Segment segment = law_segment(random);
      if (segment.from == segment.to) continue;
      const RayHit of_ray = closest_hit(index, Ray{segment.from, segment.to - segment.from});
      const RayHit of_segment = closest_hit(index, segment);
      ASSERT_EQ(is_clear(index, segment), !of_segment) << seed << ", " << i;
      if (of_segment) {
        ASSERT_EQ(of_segment.primitive, of_ray.primitive) << seed << ", " << i;
        ASSERT_EQ(of_segment.is_front, of_ray.is_front);
        ASSERT_NEAR(of_segment.t, of_ray.t, 1e-12);
        ASSERT_TRUE(of_segment.t > 0 && of_segment.t <= 1);
        ++met;
      } else if (of_ray) {
        ASSERT_GE(of_ray.t, 1 - 1e-12) << seed << ", " << i << ": what the ray meets lies behind the end";
        ++beyond;
      }
    }
  }
  if (!tries_little && is_met_often(GetParam())) {
    EXPECT_GT(met, 20u);
    EXPECT_GT(beyond, 20u);
  }
}

TEST_P(EveryKindOfLaw, AllHitsAreInOrderAndBeginWithTheClosest) {
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    const Scene scene = law_scene(GetParam(), seed + 100);
    const RayIndex index{Surfaces(scene)};
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      const Segment segment = law_segment(random);
      const Ray ray{segment.from, segment.to - segment.from};
      const std::vector<RayHit> hits = all_hits(index, ray);
      const RayHit closest = closest_hit(index, ray);
      ASSERT_EQ(hits.empty(), !closest);
      for (std::size_t k = 1; k < hits.size(); ++k)
        ASSERT_TRUE(hits[k - 1].t < hits[k].t ||
                    (hits[k - 1].t == hits[k].t && hits[k - 1].primitive < hits[k].primitive));
      if (hits.empty()) continue;
      ASSERT_EQ(hits[0].primitive, closest.primitive);
      ASSERT_EQ(hits[0].t, closest.t);
      // A ray passes through no triangle twice.
      const std::vector<PrimitiveId> ids = ids_of(hits);
      ASSERT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
    }
  }
}

// Signs are decided on exact floats. So scaling by powers of two, exchanging axes and mirroring change neither the
// triangle hit nor the place; mirroring changes the side.
TEST_P(EveryKindOfLaw, AxesScalesAndMirrorsChangeNothing) {
  for (std::uint64_t seed = 0; seed < seeds(10); ++seed) {
    const Scene scene = law_scene(GetParam(), seed + 200);
    const Surfaces surfaces(scene);
    const RayIndex index(surfaces);
    const struct {
      const char* name;
      glm::vec3 (*map)(const glm::vec3&);
      bool mirrors;
    } maps[] = {{"scaled", [](const glm::vec3& p) { return p * 0.125f; }, false},
                {"turned axes", [](const glm::vec3& p) { return glm::vec3(p.y, p.z, p.x); }, false},
                {"half a turn", [](const glm::vec3& p) { return glm::vec3(-p.x, -p.y, p.z); }, false},
                {"mirrored", [](const glm::vec3& p) { return glm::vec3(-p.x, p.y, p.z); }, true},
                {"two axes changed", [](const glm::vec3& p) { return glm::vec3(p.y, p.x, p.z); }, true}};
    for (const auto& map : maps) {
      SCOPED_TRACE(map.name);
      Scene other = scene;
      for (glm::vec3& p : other.meshes[0].positions) p = map.map(p);
      const Surfaces other_surfaces(other);
      const RayIndex other_index(other_surfaces);
      Random random(seed);
      for (int i = 0; i < 30; ++i) {
        const Segment segment = law_segment(random);
        const Segment moved{map.map(segment.from), map.map(segment.to)};
        const RayHit a = closest_hit(index, segment), b = closest_hit(other_index, moved);
        ASSERT_EQ(bool(a), bool(b)) << seed << ", " << i;
        ASSERT_EQ(is_clear(other_index, moved), !a);
        if (!a) continue;
        ASSERT_NEAR(a.t, b.t, 1e-12);
        // At equal places on the segment, rounding may name another triangle first.
        if (a.primitive == b.primitive) {
          ASSERT_EQ(b.is_front, a.is_front != map.mirrors) << seed << ", " << i;
        }
      }
    }
  }
}

TEST_P(EveryKindOfLaw, ASegmentIsClearWhereBothItsHalvesAre) {
  std::size_t blocked = 0;
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    const Scene scene = law_scene(GetParam(), seed + 300);
    const RayIndex index{Surfaces(scene)};
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      const Segment whole = law_segment(random);
      const glm::vec3 middle = (whole.from + whole.to) * 0.5f;  // exact, on the lattice of half the width
      const bool halves = is_clear(index, {whole.from, middle}) && is_clear(index, {middle, whole.to});
      const bool all = is_clear(index, whole);
      // A surface through the middle may block only the whole segment.
      if (all) {
        ASSERT_TRUE(halves) << seed << ", " << i;
      }
      if (!halves) {
        ASSERT_FALSE(all) << seed << ", " << i;
      }
      ASSERT_EQ(is_clear(index, {whole.to, whole.from}), all) << seed << ", " << i << ": from the other end";
      blocked += !all;
    }
  }
  if (is_met_often(GetParam())) {
    EXPECT_GT(blocked, 20u);
  }
}

// Rays into a closed body and out again hit as many fronts as backs, alternately, unless they pass through an edge.
TEST(ClosedBody, IsEnteredAndLeftInTurn) {
  Mesh cube;
  for (int i = 0; i < 8; ++i) cube.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Scene scene = scene_of(cube);
  const RayIndex index{Surfaces(scene)};
  Random random(8);
  int entered = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 from = glm::normalize(random.point(1) + glm::vec3(0.001f)) * 5.0f, to = random.point(1.5f);
    const std::vector<RayHit> hits = all_hits(index, {from, to - from});
    ASSERT_TRUE(hits.empty() || hits.size() == 2) << i;
    if (hits.empty()) continue;
    EXPECT_TRUE(hits[0].is_front && !hits[1].is_front) << i;
    ++entered;
  }
  EXPECT_GT(entered, 200);
  // A ray from within only leaves the body.
  for (int i = 0; i < 100; ++i) {
    const std::vector<RayHit> hits = all_hits(index, {random.point(0.9f), random.point(1) + glm::vec3(0.001f)});
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_FALSE(hits[0].is_front);
  }
}

TEST(RefusedQueries, SayHowManyAnswersThereAre) {
  const Scene scene = law_scene(Kind::soup, 1);
  const RayIndex index{Surfaces(scene)};
  const auto words = [](const auto& action) -> std::string {
    try {
      action();
      return "taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return error.what();
    }
  };
  std::vector<Ray> rays(5);
  std::vector<Segment> segments(5);
  std::vector<TrianglePoint> points(5);
  std::vector<RayHit> hits(4);
  std::vector<std::uint8_t> flags(6);
  EXPECT_EQ(words([&] { closest_hits(index, std::span<const Ray>(rays), hits); }),
            "answers: there are 4 places for 5 queries");
  EXPECT_EQ(words([&] { closest_hits(index, std::span<const Segment>(segments), hits); }),
            "answers: there are 4 places for 5 queries");
  EXPECT_EQ(words([&] { are_clear(index, segments, flags); }), "answers: there are 6 places for 5 queries");
  EXPECT_EQ(words([&] { are_lit(index, points, {0, 1, 0}, flags); }), "answers: there are 6 places for 5 queries");
  EXPECT_EQ(words([&] { are_clear(index, {}, {}); }), "taken") << "nothing is asked";
}

}  // namespace
}  // namespace frontmost::test
