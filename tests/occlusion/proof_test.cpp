// SPDX-License-Identifier: Apache-2.0
// Objects that culling calls hidden are never seen: neither along rays between the samples, nor in the z-buffer's
// pictures.
#include <gtest/gtest.h>

#include "frontmost/files.h"
#include "frontmost/occlusion.h"
#include "frontmost/zbuffer.h"
#include "occlusion/hidden_scene.h"
#include "occlusion/sight_rays.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/same_visible.h"

namespace frontmost {
namespace {

using namespace test;

TEST(OcclusionProof, NoRayMeetsWhatIsHiddenFirst) {
  std::size_t hidden = 0, seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(240); ++seed) {
    const Scene scene = hidden_scene(60, seed);
    const Surfaces surfaces(scene);
    const View view = random_view(97, 61, seed);
    Occlusion occlusion(surfaces);
    const auto sights = occlusion.cull(view, {.cell = 1 + int(seed % 4)});
    ASSERT_EQ(wrong_sights(surfaces, view, sights, {4000, seed}), 0u) << seed;
    hidden += count_of(sights, ObjectSight::hidden);
    seen += count_of(sights, ObjectSight::may_be_seen);
  }
  EXPECT_GT(hidden, seeds(240) * 10);
  EXPECT_GT(seen, seeds(240) * 5);
}

/// Compares pictures of all objects and of the visible ones alone. Adds the number of hidden objects to `hidden`.
void expect_picture_of_all(const Scene& scene, const View& view, int cell, std::size_t& hidden) {
  const Surfaces all(scene);
  Occlusion occlusion(all);
  const auto sights = occlusion.cull(view, {.cell = cell});
  hidden += count_of(sights, ObjectSight::hidden);
  // Culled objects keep their numbers, but have no triangles.
  Scene rest = scene;
  for (std::size_t i = 0; i < sights.size(); ++i)
    if (sights[i] != ObjectSight::may_be_seen) rest.instances[i].world_from_mesh = glm::dmat4(0.0);
  ASSERT_NO_FATAL_FAILURE(expect_same(zbuffer(all, view), zbuffer(Surfaces(rest), view)));
}

TEST(OcclusionProof, WhatMayBeSeenGivesThePictureOfAllToTheBit) {
  std::size_t hidden = 0;
  for (std::uint64_t seed = 0; seed < seeds(120); ++seed) {
    const Scene scene = hidden_scene(80, seed + 500);
    View view = random_view(160, 120, seed);
    view.samples = 1 << seed % 5;
    view.culling = seed % 3 == 0 ? Culling::back : seed % 7 == 0 ? Culling::front : Culling::none;
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_all(scene, view, 1, hidden)) << seed;
  }
  EXPECT_GT(hidden, seeds(120) * 10);
}

TEST(OcclusionProof, HoldsWhereTheMaterialSaysWhichSidesAreSeen) {
  std::size_t hidden = 0;
  for (std::uint64_t seed = 0; seed < seeds(120); ++seed) {
    Scene scene = hidden_scene(80, seed + 700);
    add_random_sides(scene, seed);
    View view = random_view(160, 120, seed);
    view.culling = Culling::material;
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_all(scene, view, 1, hidden)) << seed;
  }
  EXPECT_GT(hidden, seeds(120) * 5);
}

TEST(OcclusionProof, BoxesThatAreHiddenAreNotSeenEither) {
  std::size_t hidden = 0;
  for (std::uint64_t seed = 0; seed < seeds(120); ++seed) {
    Scene scene = hidden_scene(50, seed + 900);
    const Surfaces surfaces(scene);
    const View view = random_view(97, 61, seed);
    Occlusion occlusion(surfaces);
    static_cast<void>(occlusion.cull(view, {.cell = 1}));
    // New boxes, each added as an object of its own.
    Random random(seed);
    std::vector<Box> boxes(40);
    for (Box& box : boxes) {
      const glm::vec3 middle = random.point(2);
      const float size = 0.3f * random.unit();
      box.include(middle - glm::vec3(size));
      box.include(middle + glm::vec3(size, 0.5f * size, size));
    }
    std::vector<ObjectSight> sights(boxes.size());
    occlusion.find_sights(boxes, sights);
    std::vector<ObjectSight> of_all(scene.instances.size(), ObjectSight::may_be_seen);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_EQ(occlusion.sight_of(boxes[i]), sights[i]);
      const auto mesh = std::uint32_t(scene.meshes.size());
      const glm::vec3 half = (boxes[i].high - boxes[i].low) * 0.499f, middle = boxes[i].centre();
      scene.meshes.push_back(tessellated_box(half, 1, 0));
      glm::dmat4 place(1.0);
      place[3] = glm::dvec4(glm::dvec3(middle), 1.0);
      scene.instances.push_back({"", mesh, place});
      of_all.push_back(sights[i]);
      hidden += sights[i] == ObjectSight::hidden;
    }
    ASSERT_EQ(wrong_sights(Surfaces(scene), view, of_all, {4000, seed}), 0u) << seed;
  }
  EXPECT_GT(hidden, seeds(120) * 3);
}

/// Signed volume between a place and a triangle; positive on the side where the vertices run counter-clockwise.
double height_over(const std::array<glm::vec3, 3>& corners, const glm::dvec3& place) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  return glm::dot(glm::cross(b - a, c - a), place - a);
}

TEST(OcclusionProof, NeedlesThatFaceTheEyeAreNotHiddenByNothing) {
  // Snapping to the screen reverses hundreds of them.
  std::size_t facing = 0;
  for (std::uint64_t seed = 0; seed < seeds(3000); ++seed) {
    Random random(seed);
    const glm::vec3 a = random.point(1), b = random.point(1), c = a + (b - a) * 0.6f + random.point(0.002f);
    Mesh needle;
    needle.positions = {a, b, c};
    needle.triangles = {{0, 1, 2}};
    if (seed % 2 == 1) {
      needle.positions.push_back(b + random.point(0.002f));
      needle.triangles.push_back({2, 1, 3});
    }
    const Scene scene = scene_of(needle);
    const Surfaces surfaces(scene);
    for (const Culling culling : {Culling::back, Culling::front}) {
      View view = make_view(0.9, 160, 120).looking({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
      view.culling = culling;
      bool is_drawn = false;
      for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
        const double height = height_over(surfaces.corners(id), view.eye());
        is_drawn = is_drawn || (culling == Culling::back ? height : -height) > 1e-9;
      }
      if (!is_drawn) continue;
      ++facing;
      Occlusion occlusion(surfaces);
      ASSERT_EQ(occlusion.cull(view, {.cell = 1})[0], ObjectSight::may_be_seen) << seed;
    }
  }
  EXPECT_GT(facing, seeds(3000) / 2);
}

/// Compares pictures of all triangles and of the visible objects' triangles alone; objects are parts of instances.
void expect_picture_of_all_triangles(const Scene& scene, const View& view, ObjectUnit unit, std::size_t& hidden) {
  const Surfaces all(scene);
  Occlusion occlusion(all, unit);
  const auto sights = occlusion.cull(view, {.cell = 1});
  hidden += count_of(sights, ObjectSight::hidden);
  Scene rest;
  for (const Instance& instance : scene.instances) {
    rest.instances.push_back(instance);
    rest.instances.back().mesh = std::uint32_t(rest.meshes.size());
    Mesh& mesh = rest.meshes.emplace_back(scene.meshes[instance.mesh]);
    for (glm::uvec3& corners : mesh.triangles) corners = glm::uvec3(0);  // keeps its number, and is not seen
  }
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (sights[i] != ObjectSight::may_be_seen) continue;
    const std::uint32_t instance = occlusion.object(i).instance;
    for (const std::uint32_t t : occlusion.triangles(i))
      rest.meshes[instance].triangles[t] = scene.meshes[scene.instances[instance].mesh].triangles[t];
  }
  ASSERT_NO_FATAL_FAILURE(expect_same(zbuffer(all, view), zbuffer(Surfaces(rest), view)));
}

TEST(OcclusionProof, PartsAndClustersThatMayBeSeenGiveThePictureOfAllToTheBit) {
  for (const ObjectUnit unit : {ObjectUnit::parts, ObjectUnit::clusters}) {
    std::size_t hidden = 0;
    for (std::uint64_t seed = 0; seed < seeds(60); ++seed) {
      Scene scene = hidden_scene(40, seed + 1500);
      scene.meshes.push_back(tessellated_box({1.5f, 1.5f, 0.1f}, 14, 0));
      scene.instances.push_back({"", std::uint32_t(scene.meshes.size() - 1), glm::dmat4(1.0)});
      View view = random_view(160, 120, seed);
      view.culling = seed % 3 == 0 ? Culling::back : Culling::none;
      ASSERT_NO_FATAL_FAILURE(expect_picture_of_all_triangles(scene, view, unit, hidden)) << seed;
    }
    EXPECT_GT(hidden, seeds(60) * 5);
  }
}

TEST(OcclusionProof, ClustersOfOneSurfaceHideTogetherWhatLiesBehindTheirSeams) {
  Scene scene = scene_of(tessellated_box({3, 3, 0.1f}, 30, 0));
  scene.meshes.push_back(tessellated_box({1, 1, 0.3f}, 1, 0));
  glm::dmat4 behind(1.0);
  behind[3] = {0, 0, -2, 1};
  scene.instances.push_back({"thing", 1, behind});
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces, ObjectUnit::clusters);
  const View view = make_view(0.8, 480, 360).looking({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  const auto sights = occlusion.cull(view, {.cell = 1});
  ASSERT_GT(sights.size(), 30u);
  EXPECT_EQ(occlusion.object(sights.size() - 1).instance, 1u);
  EXPECT_EQ(sights.back(), ObjectSight::hidden);
}

/// A view from within the scene to another place within it.
View view_within(const Scene& scene, const Box& bounds, std::uint64_t seed) {
  Random random(seed);
  const auto inside = [&] {
    const glm::vec3 at(random.within(0.1f, 0.9f), random.within(0.1f, 0.9f), random.within(0.1f, 0.9f));
    return glm::dvec3(glm::mix(bounds.low, bounds.high, at));
  };
  const glm::dvec3 eye = inside(), target = inside();
  return make_view(0.6 + double(random.unit()), 320, 240).looking(eye, target, direction(scene.up)).enclosing(bounds);
}

TEST(OcclusionProof, CitiesAndInteriorsAreTheSameWithoutWhatIsHidden) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t hidden = 0;
  for (const char* name : {"city", "scenes/city.glb", "scenes/warehouse.glb", "scenes/occlusion-room.glb",
                           "scenes/pandora.obj", "scenes/sponza.glb", "assembly/2-cylinder-engine.glb"}) {
    const std::string path(name);
    const Scene scene = path == "city" ? builtin(path) : load(model(path));
    const Box bounds = Surfaces(scene).bounds();
    for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
      const View view = view_within(scene, bounds, seed);
      ASSERT_NO_FATAL_FAILURE(expect_picture_of_all(scene, view, 1 + int(seed % 3), hidden)) << name << " " << seed;
      const Surfaces surfaces(scene);
      Occlusion occlusion(surfaces);
      EXPECT_EQ(wrong_sights(surfaces, view, occlusion.cull(view, {.cell = 1}), {20000}), 0u) << name << " " << seed;
    }
  }
  EXPECT_GT(hidden, 500u);
}

/// A wall at z = 0 with a slit `width` pixels wide at x = 0, and a small thing behind it. A pixel is a hundredth of a
/// unit wide at the wall.
Scene slit(float width) {
  Scene scene;
  Mesh wall;
  const float half = 0.005f * width;
  add_quad(wall, {-9, -9, 0}, {-half, -9, 0}, {-half, 9, 0}, {-9, 9, 0});
  add_quad(wall, {half, -9, 0}, {9, -9, 0}, {9, 9, 0}, {half, 9, 0});
  Mesh thing;
  add_quad(thing, {-0.2f, -0.2f, -1}, {0.2f, -0.2f, -1}, {0.2f, 0.2f, -1}, {-0.2f, 0.2f, -1});
  scene.meshes = {wall, thing};
  scene.instances = {{"wall", 0, glm::dmat4(1.0)}, {"thing", 1, glm::dmat4(1.0)}};
  return scene;
}

View before_slit(double x) {
  View view;
  view.width = view.height = 100;
  view.projection = make_orthographic(-0.5, 0.5, -0.5, 0.5, {0.1, 20});
  return view.looking({x, 0, 5}, {x, 0, 0}, {0, 1, 0});
}

TEST(OcclusionProof, SlitsBetweenSamplesAreSeenThrough) {
  for (const float width : {0.9f, 0.3f, 0.1f, 0.02f})
    for (double x = -0.02; x < 0.02; x += 0.00123) {
      const Scene scene = slit(width);
      const Surfaces surfaces(scene);
      Occlusion occlusion(surfaces);
      for (const int cell : {1, 2, 3, 8})
        EXPECT_EQ(occlusion.cull(before_slit(x), {.cell = cell})[1], ObjectSight::may_be_seen) << width << " " << x;
    }
  const Scene closed = slit(0);
  const Surfaces surfaces(closed);
  Occlusion occlusion(surfaces);
  EXPECT_EQ(occlusion.cull(before_slit(0.0012), {.cell = 1})[1], ObjectSight::hidden);
}

TEST(OcclusionProof, SeamsWithinASurfaceLetNothingThrough) {
  // Triangles are far smaller than a pixel, or slivers: only the end of the surface counts.
  for (const int steps : {7, 40, 60}) {
    Scene scene;
    scene.meshes.push_back(tessellated_box({3, 3, 0.5f}, steps, 0));
    scene.meshes.push_back(tessellated_box({0.3f, 0.3f, 0.3f}, 1, 0));
    glm::dmat4 behind(1.0);
    behind[3] = {0.1, 0.05, -2.0, 1.0};
    scene.instances = {{"wall", 0, glm::dmat4(1.0)}, {"thing", 1, behind}};
    const Surfaces surfaces(scene);
    Occlusion occlusion(surfaces);
    View view = make_view(0.8, 480, 360).looking({0.7, 0.3, 4}, {0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(occlusion.cull(view, {.cell = 1})[1], ObjectSight::hidden) << steps;
    // A view along the wall, which then reaches far in depth and covers one slab after another.
    view = make_view(0.8, 480, 360).looking({-2.9, 0, 1.2}, {2, 0, -1.1}, {0, 1, 0});
    EXPECT_EQ(occlusion.cull(view, {.cell = 1})[1], ObjectSight::hidden) << steps;
  }
}

}  // namespace
}  // namespace frontmost
