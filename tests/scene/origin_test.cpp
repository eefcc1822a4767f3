// SPDX-License-Identifier: Apache-2.0
// The origin of a scene: zero for scenes near zero, amid the points for far ones, and exact.
#include "scene/origin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/compose.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

glm::dvec3 origin_of(std::initializer_list<glm::dvec3> points) {
  OriginSearch search;
  for (const glm::dvec3& point : points) search.include(point);
  EXPECT_EQ(search.origin(), fitting_origin(std::span(points.begin(), points.size())));
  return search.origin();
}

TEST(Origin, IsZeroForModelsThatLieNear) {
  EXPECT_EQ(origin_of({}), glm::dvec3(0));
  EXPECT_EQ(origin_of({{0, 0, 0}, {1, 1, 1}}), glm::dvec3(0));
  EXPECT_EQ(origin_of({{100, 0, 0}, {101, 1, 1}}), glm::dvec3(0));       // 100 sizes away, but only at 100
  EXPECT_EQ(origin_of({{4000, 0, 0}, {5000, 1, 1}}), glm::dvec3(0));     // four sizes away
  EXPECT_EQ(origin_of({{5.4e6, 0, 0}, {-5.4e6, 1, 1}}), glm::dvec3(0));  // around zero
  EXPECT_EQ(origin_of({{2000, 0, 0}, {2001, 1000, 0}}), glm::dvec3(0));  // the size is that of the longest axis
}

TEST(Origin, IsTheRoundestNumberNearModelsThatLieFar) {
  EXPECT_EQ(origin_of({{5400000.25, -3, 2}, {5400100.5, 5, 6}}), glm::dvec3(5.4e6, 0, 0));
  EXPECT_EQ(origin_of({{1e8 + 1, -1e8 - 1, 7}, {1e8 + 3, -1e8, 9}}), glm::dvec3(1e8, -1e8, 0));
  EXPECT_EQ(origin_of({{500003, 5400007, 103}, {500013, 5400017, 110}}), glm::dvec3(500000, 5.4e6, 100));
  EXPECT_EQ(origin_of({{0.5, 0, 0}, {0.5 + 1e-6, 0, 0}}), glm::dvec3(0.5, 0, 0));  // in any unit
  EXPECT_EQ(origin_of({{3e12, 0, 0}, {3e12 + 1, 0, 0}}), glm::dvec3(3e12, 0, 0));
}

TEST(Origin, PassesOverWhatFloatsCannotReach) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(origin_of({{1e8, 0, 0}, {nan, 0, 0}, {-1e39, 0, 0}, {1e8 + 1, 0, 0}}), glm::dvec3(1e8, 0, 0));
  EXPECT_EQ(origin_of({{nan, 0, 0}}), glm::dvec3(0));
}

TEST(Origin, IsTakenFromFloatsWithoutRounding) {
  std::mt19937 random(test::noted_seed(1));
  int far = 0;
  for (int round = 0; round < 20000; ++round) {
    const double scale = std::ldexp(1.0, int(random() % 120) - 60);
    const double away = scale * std::ldexp(1.0 + random() / 4.3e9, int(random() % 30)) * (random() % 2 ? 1 : -1);
    std::vector<float> values;
    OriginSearch search;
    for (int i = 0; i < 8; ++i) {
      values.push_back(float(away + scale * (random() / 4.3e9)));
      search.include({double(values.back()), 0, 0});
    }
    const double origin = search.origin().x;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (origin == 0) {
      // Distances are near, or so far that floats see one point.
      const double distance = std::min(std::abs(*low), std::abs(*high)), size = double(*high) - double(*low);
      ASSERT_FALSE(size > 0 && distance > 4 * size && (distance > 1024 || distance > 128 * size)) << away;
      continue;
    }
    ++far;
    for (const float value : values) {
      const double moved = double(value) - origin;
      ASSERT_EQ(double(float(moved)), moved) << value << " about " << origin;
      ASSERT_LE(std::abs(moved), 5 * (double(*high) - double(*low))) << value << " about " << origin;
    }
  }
  EXPECT_GT(far, 5000);
}

Scene cube_at(const glm::dvec3& place) {
  Scene scene;
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  mesh.triangles = {{0, 1, 2}, {5, 6, 7}};
  const std::uint32_t cube = add(scene, "cube", std::move(mesh), no_index);
  frontmost::place(scene, "cube", cube, moved(place));
  Camera camera;
  camera.name = "camera";
  camera.world_from_eye = moved(place + glm::dvec3(0, 0, 5));
  scene.cameras.push_back(camera);
  Light light;
  light.world_from_light = moved(place + glm::dvec3(0, 7, 0));
  scene.lights.push_back(light);
  return scene;
}

TEST(Origin, OfASceneMovesInstancesCamerasAndLights) {
  Scene scene = cube_at({1e8, 3, -1e8});
  EXPECT_EQ(fitting_origin(scene), glm::dvec3(1e8, 0, -1e8));
  set_origin(scene, fitting_origin(scene));
  EXPECT_EQ(glm::dvec3(scene.instances[0].world_from_mesh[3]), glm::dvec3(0, 3, 0));
  EXPECT_EQ(glm::dvec3(scene.cameras[0].world_from_eye[3]), glm::dvec3(0, 3, 5));
  EXPECT_EQ(glm::dvec3(scene.lights[0].world_from_light[3]), glm::dvec3(0, 10, 0));
  EXPECT_EQ(fitting_origin(scene), glm::dvec3(1e8, 0, -1e8));  // in the coordinates of the file
  set_origin(scene, {1, 2, 3});
  EXPECT_EQ(glm::dvec3(scene.instances[0].world_from_mesh[3]), glm::dvec3(1e8 - 1, 1, -1e8 - 3));
  EXPECT_EQ(fitting_origin(cube_at({3, 0, 0})), glm::dvec3(0));
}

TEST(Origin, OfInstancesIsSoughtAmongAllOfThem) {
  Scene scene = cube_at({1e8, 0, 0});
  place(scene, "again", 0, moved({1e8 + 90, 0, 0}));
  EXPECT_EQ(fitting_origin(scene), glm::dvec3(1e8, 0, 0));
  place(scene, "at home", 0, moved({0, 0, 0}));
  EXPECT_EQ(fitting_origin(scene), glm::dvec3(0));
}

TEST(Origin, OfSeveralScenesIsTheFirstOnes) {
  Scene all;
  for (const double place : {1e8, 1e8 + 40, 0.0}) {
    Scene part = cube_at({place, 0, 0});
    set_origin(part, fitting_origin(part));
    add(all, std::move(part));
  }
  EXPECT_EQ(all.origin, glm::dvec3(1e8, 0, 0));
  EXPECT_EQ(all.instances[0].world_from_mesh[3].x, 0);
  EXPECT_EQ(all.instances[1].world_from_mesh[3].x, 40);
  EXPECT_EQ(all.instances[2].world_from_mesh[3].x, -1e8);
  EXPECT_EQ(all.cameras[1].world_from_eye[3].x, 40);
  EXPECT_EQ(all.lights[1].world_from_light[3].x, 40);
}

}  // namespace
}  // namespace frontmost
