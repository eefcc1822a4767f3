// SPDX-License-Identifier: Apache-2.0
// Views of hostile geometry: a documented answer, the same on every instruction set; and pictures that do not leak.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cfenv>
#include <cstdlib>
#include <fstream>
#include <new>

#include "ray_oracle.h"
#include "support/effort.h"
#include "support/odd_numbers.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

void expect_the_oracle(const Scene& scene, const View& view) {
  const Surfaces surfaces(scene);
  const std::uint64_t expected = content_hash(ray_oracle(surfaces, view));
  for (const Isa isa : available_isas())
    EXPECT_EQ(content_hash(raycast(surfaces, view, {.threads = 1, .isa = isa})), expected) << name(isa);
}

View from_the_front(double near = 0.5, double far = kFloatInfinity) {
  View view;
  view.width = 70, view.height = 50;
  view.world_from_eye = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.9, 1.4, {near, far});
  return view;
}

TEST(HostileRayCast, NothingAtAll) {
  const Scene empty, no_triangles = scene_of(Mesh{});
  for (const Scene* scene : {&empty, &no_triangles}) {
    const Surfaces surfaces(*scene);
    const RayIndex index(surfaces);
    EXPECT_EQ(index.triangle_count(), 0u);
    EXPECT_TRUE(index.bounds().is_empty());
    for (const PrimitiveId id : raycast(index, from_the_front()).primitives) EXPECT_EQ(id, no_primitive);
  }
}

TEST(HostileRayCast, CoordinatesThatAreNoNumbersAreNeverSeen) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {kNan, 1, 0});
  add_triangle(mesh, {-1, -1, 0}, {kFloatInfinity, -1, 0}, {0, 1, 0});
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  add_triangle(mesh, {-1, -1, 0}, {-1, -1, 0}, {0, 1, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  EXPECT_EQ(RayIndex(surfaces).triangle_count(), 1u);
  std::size_t seen = 0;
  for (const PrimitiveId id : raycast(surfaces, from_the_front()).primitives) {
    EXPECT_TRUE(id == 2 || id == no_primitive);
    seen += id == 2;
  }
  EXPECT_GT(seen, 100u);
}

TEST(HostileRayCast, HugeAndTinyCoordinates) {
  for (const float size : {1e-42f, 1e-30f, 1e-10f, 1e10f, 1e20f, 1e30f, 1e38f, 3e38f}) {
    SCOPED_TRACE(size);
    Random random(std::uint64_t(std::abs(std::log(size)) * 100));
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
      const auto corner = [&] { return random.point(1) * size; };
      add_triangle(mesh, corner(), corner(), corner());
      add_triangle(mesh, random.point(1), random.point(1), corner());
    }
    expect_the_oracle(scene_of(mesh), from_the_front());
    expect_the_oracle(scene_of(mesh), from_the_front(1e-3, 1e30));
  }
}

TEST(HostileRayCast, TrianglesFartherApartThanFloatsReach) {
  Mesh mesh;
  Random random(5);
  constexpr int kCount = 400;
  for (int i = 0; i < kCount; ++i) {
    glm::vec3 p = random.point(1e37f);
    p.x = i % 2 == 0 ? 3.2e38f : -3.2e38f;
    const glm::vec3 second = p + random.point(1e37f), third = p + random.point(1e37f);
    add_triangle(mesh, p, second, third);
  }
  const Scene scene = scene_of(mesh);
  const RayIndex index{Surfaces(scene)};
  EXPECT_EQ(index.triangle_count(), std::uint32_t(kCount));
  for (PrimitiveId id = 0; id < PrimitiveId(kCount); ++id) {
    const glm::vec3* const corner = &mesh.positions[3 * std::size_t(id)];
    const glm::vec3 middle = corner[0] / 3.0f + corner[1] / 3.0f + corner[2] / 3.0f;
    const std::vector<RayHit> hits = all_hits(index, Ray{{0, middle.y, middle.z}, {middle.x > 0 ? 1.0f : -1.0f, 0, 0}});
    const bool is_met = std::any_of(hits.begin(), hits.end(), [&](const RayHit& hit) { return hit.primitive == id; });
    EXPECT_TRUE(is_met) << id;
  }
}

TEST(HostileRayCast, TrianglesThroughTheEyeAndInItsPlane) {
  Mesh mesh;
  add_triangle(mesh, {-1, 0, 3}, {1, 0, 3}, {0, 0, -3});       // the eye lies in its plane, edge-on
  add_triangle(mesh, {0, 0, 3}, {1, 0.5f, 0}, {1, -0.5f, 0});  // the eye is its vertex
  add_triangle(mesh, {-1, -1, 3}, {1, -1, 3}, {0, 1, 3});      // crosses the eye's plane
  add_triangle(mesh, {-5, -1, 9}, {5, -1, 9}, {0, -1, -9});    // the ground, from behind to far ahead
  expect_the_oracle(scene_of(mesh), from_the_front());
  expect_the_oracle(scene_of(mesh), from_the_front(1e-6, 10));
}

TEST(HostileRayCast, TheCallersRoundingModeDoesNotMatter) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 200, 1));
  const Surfaces surfaces(scene);
  const std::uint64_t expected = content_hash(raycast(surfaces, from_the_front()));
  std::fesetround(FE_UPWARD);
  const std::uint64_t upward = content_hash(raycast(surfaces, from_the_front()));
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(upward, expected);
}

TEST(HostileRayCast, NoPixelOfAClosedSurfaceLeaks) {
  // Rays from inside, in all directions, also through edges and vertices, as vertices project to whole pixels.
  Mesh mesh;
  const glm::vec3 corner[8] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  for (const auto& q : {glm::ivec4(0, 1, 2, 3), glm::ivec4(4, 7, 6, 5), glm::ivec4(0, 4, 5, 1), glm::ivec4(1, 5, 6, 2),
                        glm::ivec4(2, 6, 7, 3), glm::ivec4(3, 7, 4, 0)}) {
    add_triangle(mesh, corner[q.x], corner[q.y], corner[q.z]);
    add_triangle(mesh, corner[q.x], corner[q.z], corner[q.w]);
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    View view;
    view.width = 65, view.height = 65;
    view.samples = i % 3 == 0 ? 4 : 1;
    const glm::dvec3 forward[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, glm::dvec3(random.point(1))};
    view.world_from_eye = look_at({0, 0, 0}, forward[i % 6], {0.1, 0.2, 1});
    view.projection = make_projection(glm::radians(90.0 + i), 1, {1e-3, 100});
    std::size_t open = 0;
    for (const PrimitiveId id : raycast(surfaces, view).primitives) open += id == no_primitive;
    EXPECT_EQ(open, 0u) << i;
  }
}

TEST(RayCaster, ReusesItsMemoryForTheSameAnswers) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 500, 2)), other = scene_of(random_mesh(Kind::tiny, 5000, 2));
  const Surfaces surfaces(scene), more(other);
  const RayIndex index(surfaces), second(more);
  RayCaster caster;
  const View view = from_the_front();
  View larger = view;
  larger.width = 128, larger.samples = 2;
  for (const View& v : {view, larger, view, view}) {
    EXPECT_EQ(content_hash(caster.draw(index, v)), content_hash(raycast(index, v)));
    EXPECT_EQ(content_hash(caster.draw(second, v)), content_hash(raycast(second, v)));
  }
  EXPECT_EQ(content_hash(caster.take()), content_hash(raycast(second, view)));
  EXPECT_EQ(content_hash(caster.draw(index, view)), content_hash(raycast(index, view)));
}

TEST(RayIndex, StaysBelowItsPromisedSize) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 100'000, 8));
  const RayIndex index{Surfaces(scene)};
  EXPECT_EQ(index.triangle_count(), 100'000u);
  EXPECT_LT(double(index.byte_count()) / index.triangle_count(), 50);
}

TEST(HostileRayCast, WithoutMemoryForAllPlanesNoneIsUsed) {
  if (under_sanitizer) GTEST_SKIP() << "a sanitizer takes all addresses for itself";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto cast_twice = [] {
    const Scene empty;
    const RayIndex index{Surfaces(empty)};
    RayCaster caster;
    View view = from_the_front();
    view.width = view.height = 16384;  // 1 GiB a plane
    // The memory limit leaves room for current memory, one plane, and half of the other.
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * 4096 + (std::size_t(3) << 29), RLIM_INFINITY};
    setrlimit(RLIMIT_AS, &limit);
    int failures = 0;
    for (int i = 0; i < 2; ++i) try {
        (void)caster.draw(index, view, {.threads = 1});
      } catch (const std::bad_alloc&) {
        ++failures;
      }
    std::exit(failures == 2 ? 0 : 1);
  };
  EXPECT_EXIT(cast_twice(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace frontmost::test
