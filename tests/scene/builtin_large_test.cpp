// SPDX-License-Identifier: Apache-2.0
// The composed scenes: their promised properties, and no accidental intersections.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "frontmost/scene.h"

namespace frontmost {
namespace {

Box world_box(const Scene& scene, const Instance& instance) {
  Box box;
  for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
    box.include(glm::vec3(instance.world_from_mesh * glm::dvec4(p, 1)));
  return box;
}

const Instance* find(const Scene& scene, std::string_view name) {
  for (const Instance& instance : scene.instances)
    if (instance.name == name) return &instance;
  return nullptr;
}

std::uint64_t stored_triangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
  return count;
}

TEST(City, IsLargeInstancedAndOfManyParts) {
  const Scene scene = builtin("city");
  EXPECT_GT(triangle_count(scene), 110000u);
  EXPECT_LT(triangle_count(scene), 130000u);
  EXPECT_LT(stored_triangles(scene), 20000u);
  EXPECT_GT(scene.instances.size(), 1000u);
  EXPECT_GE(scene.materials.size(), 12u);
}

TEST(City, IsTallestInTheMiddle) {
  const Scene scene = builtin("city");
  float middle = 0, rim = 0;
  for (const Instance& instance : scene.instances) {
    const Box box = world_box(scene, instance);
    if (instance.name.rfind("lot", 0) != 0) continue;
    const glm::vec3 at = box.centre();
    float& tallest = std::max(std::abs(at.x), std::abs(at.z)) < 200 ? middle : rim;
    tallest = std::max(tallest, box.high.y);
  }
  EXPECT_GT(middle, 60);
  EXPECT_LT(rim, middle / 2);
}

TEST(City, BuildingsStandOnTheirLotsWithoutTouching) {
  const Scene scene = builtin("city");
  std::vector<Box> lots;
  for (const Instance& instance : scene.instances)
    if (instance.name.rfind("lot", 0) == 0) lots.push_back(world_box(scene, instance));
  EXPECT_GT(lots.size(), 500u);
  for (std::size_t a = 0; a < lots.size(); ++a) {
    EXPECT_FLOAT_EQ(lots[a].low.y, 0.15f);
    for (std::size_t b = 0; b < a; ++b)
      ASSERT_FALSE(lots[a].low.x < lots[b].high.x && lots[b].low.x < lots[a].high.x && lots[a].low.z < lots[b].high.z &&
                   lots[b].low.z < lots[a].high.z)
          << a << " and " << b;
  }
}

TEST(Spheres, RestOnTheStageAndDoNotTouch) {
  const Scene scene = builtin("spheres");
  EXPECT_EQ(scene.instances.size(), 41u);
  const float top = world_box(scene, *find(scene, "stage")).high.y;
  std::set<std::pair<float, float>> looks;
  for (std::size_t a = 1; a < scene.instances.size(); ++a) {
    const glm::dmat4& at = scene.instances[a].world_from_mesh;
    EXPECT_NEAR(at[3].y - at[0].x, top, 1e-6);
    EXPECT_LT(glm::length(glm::dvec2(at[3].x, at[3].z)) + at[0].x, 4.8) << "over the edge of the stage";
    for (std::size_t b = 1; b < a; ++b) {
      const glm::dmat4& other = scene.instances[b].world_from_mesh;
      ASSERT_GT(glm::length(glm::dvec3(at[3] - other[3])), at[0].x + other[0].x) << a << " and " << b;
    }
    const Material& material = scene.materials[scene.meshes[scene.instances[a].mesh].material_of(0)];
    looks.emplace(material.metallic, material.roughness);
  }
  EXPECT_EQ(looks.size(), 10u) << "five roughnesses, with and without metal";
}

TEST(Gallery, HasWhatTheDemoNeeds) {
  const Scene scene = builtin("gallery");
  for (const char* name : {"teapot", "coral cube", "ink cube", "knot", "vase", "pane", "stage"})
    EXPECT_NE(find(scene, name), nullptr) << name;
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.instances.back().name, "pane");
  const Material& glass = scene.materials[scene.meshes[scene.instances.back().mesh].material_of(0)];
  EXPECT_EQ(glass.alpha, Material::Alpha::blend);
  EXPECT_LT(glass.base_color.a, 0.5f);
  EXPECT_GE(scene.cameras.size(), 2u);
}

TEST(Gallery, EverythingStandsOnTheStage) {
  const Scene scene = builtin("gallery");
  const float top = world_box(scene, *find(scene, "tiles")).high.y;
  for (const Instance& instance : scene.instances) {
    if (instance.name == "stage" || instance.name == "tiles") continue;
    const Box box = world_box(scene, instance);
    EXPECT_GE(box.low.y, top - 1e-6f) << instance.name;
    EXPECT_LT(std::max(glm::length(glm::vec2(box.low.x, box.low.z)), glm::length(glm::vec2(box.high.x, box.high.z))),
              4.4f)
        << instance.name << " is over the edge";
  }
}

}  // namespace
}  // namespace frontmost
