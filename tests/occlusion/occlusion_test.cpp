// SPDX-License-Identifier: Apache-2.0
#include "frontmost/occlusion.h"

#include <gtest/gtest.h>

#include "occlusion/hidden_scene.h"
#include "support/effort.h"
#include "support/refusal.h"

namespace frontmost {
namespace {

using namespace test;

/// A wall of 4 x 4 units at z = 0, and an object ("thing") two units behind it.
Scene wall_and_thing() {
  Scene scene;
  Mesh wall;
  add_square(wall, 2, 0);
  scene.meshes = {wall, tessellated_box({0.5f, 0.5f, 0.5f}, 1, 0)};
  glm::dmat4 behind(1.0);
  behind[3] = {0.0, 0.0, -2.0, 1.0};
  scene.instances = {{"wall", 0, glm::dmat4(1.0)}, {"thing", 1, behind}};
  return scene;
}

View from(const glm::dvec3& eye) { return make_view(0.8, 200, 150).looking(eye, {0, 0, -1}, {0, 1, 0}); }

ObjectSight sight_of_thing(const Scene& scene, const View& view) {
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces);
  return occlusion.cull(view)[1];
}

TEST(Occlusion, AWallHidesWhatLiesBehindIt) {
  const Scene scene = wall_and_thing();
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, 4})), ObjectSight::hidden);
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, -6})), ObjectSight::may_be_seen);                // from behind
  EXPECT_EQ(sight_of_thing(scene, from({9, 0, 4})), ObjectSight::may_be_seen);                 // past its edge
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, -2})), ObjectSight::may_be_seen);                // from within
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, 4}).between(5, 20)), ObjectSight::may_be_seen);  // the wall is too near
}

TEST(Occlusion, WhatIsBesideOrBeforeOrBehindTheVolumeIsOutside) {
  Scene scene = wall_and_thing();
  const View view = from({0, 0, 4});
  for (const glm::dvec3& place : {glm::dvec3(50, 0, -2), glm::dvec3(-50, 0, -2), glm::dvec3(0, 50, -2),
                                  glm::dvec3(0, -50, -2), glm::dvec3(0, 0, 9), glm::dvec3(0, 0, -90)}) {
    scene.instances[1].world_from_mesh[3] = glm::dvec4(place, 1.0);
    EXPECT_EQ(sight_of_thing(scene, view.between(0.1, 50)), ObjectSight::outside) << place.x << " " << place.y;
  }
  scene.meshes[1].triangles.clear();
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::outside);
}

TEST(Occlusion, HolesGlassBlendedSurfacesAndCulledFacesHideNothing) {
  const View view = from({0, 0, 4});
  Scene scene = wall_and_thing();
  scene.materials.resize(1);
  scene.meshes[0].material_ids = {0};
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::hidden);
  scene.materials[0].alpha = Material::Alpha::blend;
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::may_be_seen);
  scene.materials[0].alpha = Material::Alpha::mask;
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::may_be_seen);
  scene.materials[0] = {};
  scene.materials[0].transmission.factor = 0.01f;
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::may_be_seen);
  scene.materials[0].unlit = true;  // unlit, it lets no light through
  EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::hidden);
  scene.materials.clear();
  scene.meshes[0].material_ids.clear();
  View culled = view;
  culled.culling = Culling::back;
  EXPECT_EQ(sight_of_thing(scene, culled), ObjectSight::hidden);
  culled.culling = Culling::front;
  EXPECT_EQ(sight_of_thing(scene, culled), ObjectSight::may_be_seen);
  scene.instances[0].world_from_mesh[0][0] = -1;  // mirrored: its front still faces +z
  EXPECT_EQ(sight_of_thing(scene, culled), ObjectSight::may_be_seen);
  culled.culling = Culling::back;
  EXPECT_EQ(sight_of_thing(scene, culled), ObjectSight::hidden);
}

/// A floor of two triangles from behind the eye to far away, and a thing below it, much nearer than the floor's far
/// end.
Scene floor_and_thing(double distance) {
  Scene scene = wall_and_thing();
  scene.meshes[0] = Mesh();
  add_quad(scene.meshes[0], {-80, -1, 10}, {80, -1, 10}, {80, -1, -150}, {-80, -1, -150});
  scene.instances[1].world_from_mesh[3] = {0, -2, -distance, 1};
  return scene;
}

TEST(Occlusion, AFloorHidesWhatLiesBelowItAlsoFarBeforeItsEnd) {
  const View view = make_view(1.2, 200, 150).looking({1, 0, 0}, {1, -0.3, -1}, {0, 1, 0}).between(0.1, 500);
  for (const double distance : {4.0, 8.0, 16.0, 40.0})
    EXPECT_EQ(sight_of_thing(floor_and_thing(distance), view), ObjectSight::hidden) << distance;
  Scene above = floor_and_thing(8);
  above.instances[1].world_from_mesh[3].y = -1;  // it protrudes from the floor
  EXPECT_EQ(sight_of_thing(above, view), ObjectSight::may_be_seen);
  View parallel = view;
  parallel.projection = make_orthographic(-20, 20, -15, 15, {0.1, 500});
  EXPECT_EQ(sight_of_thing(above, parallel), ObjectSight::may_be_seen);
  above.instances[1].world_from_mesh[3] = {0, -6, -40, 1};  // the floor is 17 units in front of it
  EXPECT_EQ(sight_of_thing(above, parallel), ObjectSight::hidden);
}

TEST(Occlusion, WhatTheNearPlaneCutsOffHidesNothingInParallelProjection) {
  // The near plane cuts the wall: the rest of the wall ends within the picture, before the thing's middle.
  Scene scene = wall_and_thing();
  Mesh wall;
  add_quad(wall, {-4, -4, 4}, {4, -4, -4}, {4, 4, -4}, {-4, 4, 4});
  scene.meshes[0] = wall;
  scene.instances[1].world_from_mesh[3] = {0, 0, -5, 1};
  for (int i = 0; i < 400; ++i) {
    View view = from({0, 0, 10});
    const double near = 10.5 + 0.001 * i;
    view.projection = make_orthographic(-2, 2, -1.5, 1.5, {near, near + 20 + 0.37 * i});
    EXPECT_EQ(sight_of_thing(scene, view), ObjectSight::may_be_seen) << i;
  }
}

TEST(Occlusion, TwoThingsTogetherHideAThird) {
  Scene scene = wall_and_thing();
  Mesh left, right;  // They overlap by a few pixels, and neither hides the thing alone.
  add_quad(left, {-3, -3, 0}, {0.05f, -3, 0}, {0.05f, 3, 0}, {-3, 3, 0});
  add_quad(right, {-0.05f, -3, -0.5f}, {3, -3, -0.5f}, {3, 3, -0.5f}, {-0.05f, 3, -0.5f});
  scene.meshes[0] = left;
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, 4})), ObjectSight::may_be_seen);
  scene.meshes.push_back(right);
  scene.instances.push_back({"right", 2, glm::dmat4(1.0)});
  EXPECT_EQ(sight_of_thing(scene, from({0, 0, 4})), ObjectSight::hidden);
}

TEST(Occlusion, PartsOfOneMeshAreObjectsOfTheirOwn) {
  Scene scene;
  Mesh mesh;
  add_square(mesh, 2, 0);
  add_square(mesh, 0.4f, -2);
  add_square(mesh, 0.4f, 2);
  scene = scene_of(mesh);
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_mesh[3] = {100, 0, 0, 1};
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces, ObjectUnit::parts);
  ASSERT_EQ(occlusion.object_count(), 6u);
  EXPECT_EQ(occlusion.object(4).instance, 1u);
  EXPECT_EQ(occlusion.object(4).part, 1u);
  const auto sights = occlusion.cull(from({0, 0, 6}));
  EXPECT_EQ(sights[0], ObjectSight::may_be_seen);
  EXPECT_EQ(sights[1], ObjectSight::hidden);
  EXPECT_EQ(sights[2], ObjectSight::may_be_seen);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(sights[i], ObjectSight::outside);
}

TEST(Occlusion, AnswersAreThoseOfEveryInstructionSetAndThreadCountAndOfAFreshStart) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) scenes.push_back(hidden_scene(70, seed + 300));
  for (std::uint64_t seed = 0; seed < scenes.size(); ++seed) {
    const Surfaces surfaces(scenes[seed]);
    Occlusion kept(surfaces);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const View view = random_view(50 + 83 * int(k), 41 + 30 * int(k), seed + 100 * k);
      const auto sights = kept.cull(view, {.cell = 1});
      const std::vector<ObjectSight> expected(sights.begin(), sights.end());
      for (const Isa isa : available_isas()) {
        const Execution execution{.threads = isa == Isa::best ? 3 : 2, .isa = isa};
        Occlusion fresh(surfaces, ObjectUnit::instances, execution);
        const auto other = fresh.cull(view, {.cell = 1}, execution);
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), other.begin())) << name(isa) << " " << seed;
      }
    }
  }
}

/// Vertices of such boxes overflow in front of the eye: the answer for NaN must not depend on the processor.
TEST(Occlusion, BoxesAtTheEndOfTheFloatsHaveTheSameAnswerOnEveryInstructionSet) {
  View view = make_view(0.9, 640, 480).looking({0, 0, 0}, {-0.0216184, -0.816451, 0.577009}, {0, 1, 0});
  view.projection.clip = {0.1, std::numeric_limits<double>::infinity()};
  Scene scene;
  Mesh wall;  // does not cover the whole picture
  for (const glm::dvec2 at : {glm::dvec2(-0.5, -0.7), {0.7, -0.7}, {0.7, 0.7}, {-0.5, 0.7}})
    wall.positions.emplace_back(view.forward() + view.right() * at.x + view.up() * at.y);
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  add(scene, wall);
  const Surfaces surfaces(scene);
  std::vector<Box> boxes;
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 40; ++k) {
      const float high = -2.41e33f + 5e31f * float(i), far = 5.89e33f - 5e31f * float(k);
      boxes.push_back({{-2.98e32f, -8.33e33f, 0}, {0, high, far}});
    }
  std::vector<ObjectSight> expected;
  for (const Isa isa : available_isas()) {
    const Execution execution{.threads = 1, .isa = isa};
    Occlusion occlusion(surfaces, ObjectUnit::instances, execution);
    (void)occlusion.cull(view, {}, execution);
    std::vector<ObjectSight> sights(boxes.size());
    occlusion.find_sights(boxes, sights);
    if (expected.empty()) expected = sights;
    EXPECT_EQ(sights, expected) << name(isa);
  }
}

TEST(Occlusion, DistancesThatOverflowInParallelProjectionAreTheFarthest) {
  Scene scene;
  for (const float z : {-3e38f, 3e38f, -1e38f}) {
    Mesh mesh;
    mesh.positions = {{-1, -1, z}, {1, -1, z}, {0, 1, z}};
    mesh.triangles = {{0, 1, 2}};
    scene.instances.push_back({"at " + std::to_string(z), std::uint32_t(scene.meshes.size()), glm::dmat4(1.0)});
    scene.meshes.push_back(mesh);
  }
  const Surfaces surfaces(scene);
  View view = from({0, 0, 0});
  view.projection = make_orthographic(-1, 1, -1, 1, {-3e38, 3e38});
  Occlusion occlusion(surfaces);
  EXPECT_EQ(occlusion.cull(view)[1], ObjectSight::may_be_seen);
}

TEST(Occlusion, CellsOutOfRangeAndBrokenViewsAreRefused) {
  const Scene scene = wall_and_thing();
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces);
  EXPECT_EQ(occlusion.sight_of({{-1, -1, -1}, {1, 1, 1}}), ObjectSight::outside);  // before the first view
  for (const int cell : {0, -1, 65})
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument,
                         [&] {
                           static_cast<void>(occlusion.cull(from({0, 0, 4}), {.cell = cell}));
                         }),
              "occlusion: a cell must be 1 to 64 pixels wide");
  EXPECT_EQ(code_of([&] { static_cast<void>(occlusion.cull(View{})); }), ErrorCode::bad_argument);
}

TEST(Occlusion, EmptyScenesAndBoxesAreNoTrouble) {
  const Scene scene;
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces);
  EXPECT_TRUE(occlusion.cull(from({0, 0, 4})).empty());
  EXPECT_EQ(occlusion.sight_of(Box()), ObjectSight::outside);
  EXPECT_EQ(occlusion.sight_of({{-1, -1, -1}, {1, 1, 1}}), ObjectSight::may_be_seen);
}

}  // namespace
}  // namespace frontmost
