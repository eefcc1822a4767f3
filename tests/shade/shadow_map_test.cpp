// SPDX-License-Identifier: Apache-2.0
// Shadow maps against rays: at each point, the map must agree with a ray to the light, except at a soft edge.
#include "shade/shadow/shadow_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "shade/support.h"
#include "support/key_light_map.h"

namespace frontmost::shading {
namespace {

using namespace test;

/// A floor of side 4 at z = 0, and a square of side 1 floating above its middle, seen from above.
Scene floor_and_roof(double height) {
  Scene scene = scene_of(square());
  scene.instances[0].world_from_mesh = glm::dmat4(2.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.instances.push_back({"roof", 0, glm::dmat4(0.5)});
  scene.instances[1].world_from_mesh[3] = {0, 0, height, 1};
  return scene;
}

struct Shadowed {
  Scene scene;
  Surfaces surfaces;
  Visible visible;
  Visible planes;  ///< borrowed by the map
  ShadowMap map;

  Shadowed(Scene s, const glm::dvec3& to_light, const View& view = front_view(256), const Execution& execution = {})
      : scene(std::move(s)),
        surfaces(scene),
        visible(zbuffer(surfaces, view)),
        map(light_map(surfaces, visible, glm::normalize(to_light), planes, execution)) {}

  [[nodiscard]] float at(const glm::dvec3& world, const glm::vec3& normal = {0, 0, 1}) const {
    return light_at(map, glm::vec3(world - visible.view.eye()), normal);
  }
};

TEST(ShadowMap, AgreesWithRaysAwayFromTheEdge) {
  for (const glm::dvec3 to_light : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 1, 2), glm::dvec3(2, 0.5, 1)}) {
    const double height = 0.4;
    const Shadowed shadowed(floor_and_roof(height), to_light, front_view(640));
    int in_shadow = 0;
    for (double x = -1.8; x < 1.8; x += 0.07)
      for (double y = -1.8; y < 1.8; y += 0.07) {
        const glm::dvec2 hit = glm::dvec2(x, y) + height / to_light.z * glm::dvec2(to_light);
        const double outside = std::max(std::abs(hit.x), std::abs(hit.y)) - 0.5;
        if (std::abs(outside) < 0.06) continue;  // too close to the soft edge, or within the bias
        ASSERT_EQ(shadowed.at({x, y, 0}), outside > 0 ? 1.0f : 0.0f) << x << ", " << y;
        in_shadow += outside < 0;
      }
    EXPECT_GT(in_shadow, 60);
  }
}

TEST(ShadowMap, EdgesFadeWithoutSteps) {
  const Shadowed shadowed(floor_and_roof(0.4), {0, 0, 1});
  float last = 0;
  int between = 0;
  for (double x = 0.4; x < 0.6; x += 0.0005) {
    const float light = shadowed.at({x, 0, 0});
    EXPECT_GE(light, last - 1e-5f) << x;
    EXPECT_LT(light, last + 0.06f) << x;
    between += light > 0 && light < 1;
    last = light;
  }
  EXPECT_EQ(last, 1.0f);
  EXPECT_GT(between, 10);
  EXPECT_NEAR(shadowed.at({0.5, 0, 0}), 0.5f, 0.15f);
}

TEST(ShadowMap, TheRoofIsLit) {
  for (const glm::dvec3 to_light : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 1, 2), glm::dvec3(3, 0.5, 1)}) {
    const Shadowed shadowed(floor_and_roof(0.4), to_light);
    for (double x = -0.45; x < 0.45; x += 0.1)
      for (double y = -0.45; y < 0.45; y += 0.1) ASSERT_EQ(shadowed.at({x, y, 0.4}), 1.0f) << x << ", " << y;
  }
}

TEST(ShadowMap, WhatIsNotInThePictureStillThrowsItsShadow) {
  // The view shows only a corner of the floor; the roof is outside of the view, towards the light.
  View view = front_view(256);
  view.projection = make_orthographic(0.6, 1.4, -0.4, 0.4, {1, 20});
  const double height = 0.4;
  const Shadowed shadowed(floor_and_roof(height), {-1, 0, 0.4}, view);
  EXPECT_EQ(shadowed.at({0.9, 0, 0}), 0.0f);
  EXPECT_EQ(shadowed.at({0.9, 0, 0.39}), 1.0f);
}

// A view from the front with the light overhead: the picture's up does not determine the rotation of the map.
TEST(ShadowMap, IsThereForALightStraightAboveOrBelowThePicture) {
  for (const double side : {1.0, -1.0}) {
    View front = front_view(256);
    front.world_from_eye = look_at({0, -6, 0.2}, {0, 0, 0.2}, {0, 0, side});
    front.projection = make_projection(0.8, 1, {1, 30});
    ASSERT_EQ(front.up(), glm::dvec3(0, 0, side));
    for (const glm::dvec3 to_light : {glm::dvec3(0, 0, 1), glm::dvec3(1e-9, 0, 1), glm::dvec3(1e-5, 0, 1)}) {
      const Shadowed shadowed(floor_and_roof(0.4), to_light, front);
      EXPECT_EQ(shadowed.at({0, 0, 0}), 0.0f);
      EXPECT_EQ(shadowed.at({0.9, 0, 0}), 1.0f);
      EXPECT_EQ(shadowed.at({0, 0, 0.4}), 1.0f);
    }
  }
}

TEST(ShadowMap, NothingSeenIsAllLit) {
  View away = front_view(32);
  away.world_from_eye = look_at({0, 0, 10}, {0, 0, 20}, {0, 1, 0});
  const Shadowed shadowed(floor_and_roof(0.4), {0, 0, 1}, away);
  EXPECT_EQ(shadowed.at({0, 0, 0}), 1.0f);
}

TEST(ShadowMap, OutOfTheMapAndNotANumberAreLit) {
  const Shadowed shadowed(floor_and_roof(0.4), {0, 0, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const glm::dvec3 p : {glm::dvec3(1e6, 0, 0), glm::dvec3(0, -1e6, 0), glm::dvec3(nan, 0, 0)})
    EXPECT_EQ(shadowed.at(p), 1.0f);
}

TEST(ShadowMap, DoesNotDependOnThreads) {
  const Shadowed one(floor_and_roof(0.4), {-1, 1, 2}, front_view(256), {.threads = 1});
  const Shadowed many(floor_and_roof(0.4), {-1, 1, 2}, front_view(256), {.threads = 4});
  for (double x = -1; x < 1; x += 0.01) ASSERT_EQ(one.at({x, 0.3 * x, 0}), many.at({x, 0.3 * x, 0})) << x;
}

/// The tent filter over the texels around a point, one by one in doubles.
double filtered_one_by_one(const ShadowGrid& grid, const glm::vec3& position, const glm::vec3& normal) {
  const double x = glm::dot(grid.texel_x, position) + grid.at_eye.x,
               y = glm::dot(grid.texel_y, position) + grid.at_eye.y;
  const double cosine = std::abs(glm::dot(normal, grid.to_light));
  const double slope = std::min(8.0, std::sqrt(std::max(0.0, 1 - cosine * cosine)) / std::max(cosine, 1e-9));
  const double key = double(glm::dot(grid.key, position)) + grid.at_eye.z + grid.key_bias + slope * grid.key_slope_bias;
  double sum = 0;
  for (int v = int(y) - 6; v < int(y) + 7; ++v)
    for (int u = int(x) - 6; u < int(x) + 7; ++u) {
      const double weight = std::max(0.0, 4 - std::abs(u + 0.5 - x)) * std::max(0.0, 4 - std::abs(v + 0.5 - y));
      if (weight > 0 && grid.keys[v * grid.size + u] <= key) sum += weight;
    }
  return sum / 256;
}

TEST(ShadowMap, IsATentOverTheTexelsAroundAPointOnEveryInstructionSet) {
  const Shadowed shadowed(floor_and_roof(0.4), {-1, 1, 2});
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.2f, 1));
  int partly = 0;
  for (double x = -1; x < 1; x += 0.017)
    for (double y = -1; y < 1; y += 0.013) {
      const glm::vec3 at(glm::dvec3(x, y, 0.001) - shadowed.visible.view.eye());
      const float light = light_at(shadowed.map, at, normal);
      ASSERT_NEAR(light, filtered_one_by_one(shadowed.map.grid(), at, normal), 1e-4) << x << ", " << y;
      for (const Isa isa : available_isas()) ASSERT_EQ(light_at(shadowed.map, at, normal, isa), light) << name(isa);
      partly += light > 0 && light < 1;
    }
  EXPECT_GT(partly, 200);
}

TEST(ShadowMap, IsAsFineAsThePictureNeeds) {
  const auto texels = [](int size) {
    const Scene scene = floor_and_roof(0.4);
    const Surfaces surfaces(scene);
    return view_of_light(zbuffer(surfaces, front_view(size)), surfaces.bounds(), {0, 0, 1}, {})->width;
  };
  EXPECT_EQ(texels(40), 256);
  EXPECT_EQ(texels(256), 448);
  EXPECT_EQ(texels(640), 1024);
  EXPECT_EQ(texels(2000), 1024);
}

}  // namespace
}  // namespace frontmost::shading
