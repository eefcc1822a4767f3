// SPDX-License-Identifier: Apache-2.0
#include "scene/compose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace frontmost {
namespace {

TEST(Compose, CameraAtPutsTheTargetOnTheAxis) {
  const Camera camera = camera_at("test", {3, 4, 5}, {-1, 2, 0.5}, 90);
  const glm::dvec4 target = glm::inverse(camera.world_from_eye) * glm::dvec4(-1, 2, 0.5, 1);
  EXPECT_NEAR(target.x, 0, 1e-12);
  EXPECT_NEAR(target.y, 0, 1e-12);
  EXPECT_NEAR(target.z, -glm::length(glm::dvec3(4, 2, 4.5)), 1e-12);
  EXPECT_NEAR(camera.vertical, std::numbers::pi / 2, 1e-15);
}

TEST(Compose, TurnedIsCounterClockwiseSeenFromAbove) {
  // Seen from above, x points right and z down, so a quarter turn takes x to -z.
  const glm::dvec4 x = turned(1, 4) * glm::dvec4(1, 0, 0, 1);
  EXPECT_EQ(x, glm::dvec4(0, 0, -1, 1));
  EXPECT_EQ(tilted(1, 4) * glm::dvec4(0, 1, 0, 1), glm::dvec4(0, 0, 1, 1));
  EXPECT_NEAR(glm::determinant(turned(1, 7) * tilted(2, 9)), 1, 1e-15);
}

TEST(Compose, ColorIsTheSrgbCurve) {
  EXPECT_EQ(color(0x000000), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(color(0xFFFFFF, 0.5), glm::vec4(1, 1, 1, 0.5));
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    const double value = byte / 255.0;
    const double expected = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(color(byte << 8).y, expected, 1e-7) << byte;
  }
}

TEST(Compose, CategoriesThatBothScenesHaveAreOne) {
  const auto kitchen = [](std::vector<Category> categories) {
    Scene scene;
    scene.categories = std::move(categories);
    for (std::uint32_t i = 0; i <= scene.categories.size(); ++i) {
      add(scene, Mesh());
      scene.instances[i].category = i < scene.categories.size() ? i : no_index;
    }
    return scene;
  };
  Scene scene = kitchen({{"cup", 1}, {"bowl", 2}});
  add(scene, kitchen({{"bowl", 2}, {"cup", 7}, {"cup", 1}}));
  ASSERT_EQ(scene.categories.size(), 3u);
  EXPECT_EQ(scene.categories[2].name, "cup");
  EXPECT_EQ(scene.categories[2].number, 7u);
  std::vector<std::uint32_t> of_objects;
  for (const Instance& instance : scene.instances) of_objects.push_back(instance.category);
  EXPECT_EQ(of_objects, (std::vector<std::uint32_t>{0, 1, no_index, 1, 2, 0, no_index}));
  EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace frontmost
