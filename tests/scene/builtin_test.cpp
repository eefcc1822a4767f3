// SPDX-License-Identifier: Apache-2.0
// Every built-in scene is valid, named, finite, seen by its cameras, and the same to the bit everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "frontmost/scene.h"

namespace frontmost {
namespace {

class Builtin : public testing::TestWithParam<std::string_view> {
 protected:
  const Scene scene = builtin(GetParam());
};

TEST_P(Builtin, IsValidAndNamed) {
  EXPECT_NO_THROW(validate(scene));
  EXPECT_EQ(scene.name, GetParam());
  EXPECT_EQ(scene.up, Axis::y);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_GT(triangle_count(scene), 0u);
  EXPECT_FALSE(scene.cameras.empty());
  for (const Instance& instance : scene.instances) EXPECT_FALSE(instance.name.empty());
  for (const Mesh& mesh : scene.meshes) EXPECT_FALSE(mesh.name.empty());
  for (const Material& material : scene.materials) EXPECT_FALSE(material.name.empty());
}

TEST_P(Builtin, ObjectsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Instance& instance : scene.instances)
    EXPECT_TRUE(names.insert(instance.name).second) << instance.name << " twice";
}

TEST_P(Builtin, UsesEveryMeshAndMaterial) {
  std::set<std::uint32_t> meshes, materials;
  for (const Instance& instance : scene.instances) meshes.insert(instance.mesh);
  for (const Mesh& mesh : scene.meshes) materials.insert(mesh.material_ids.begin(), mesh.material_ids.end());
  EXPECT_EQ(meshes.size(), scene.meshes.size());
  EXPECT_EQ(materials.size(), scene.materials.size());
}

TEST_P(Builtin, HasFinitePositionsAndUnitNormals) {
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::vec3& p : mesh.positions)
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << mesh.name;
    for (const glm::vec3& n : mesh.normals.values) ASSERT_NEAR(glm::length(n), 1, 1e-6) << mesh.name;
  }
}

TEST_P(Builtin, HasNoTriangleWithoutArea) {
  for (const Mesh& mesh : scene.meshes)
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
      ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 1e-9) << mesh.name;
    }
}

TEST_P(Builtin, CamerasAreRigidAndLookAtTheScene) {
  Box bounds;
  for (const Instance& instance : scene.instances)
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      bounds.include(glm::vec3(instance.world_from_mesh * glm::dvec4(p, 1)));
  for (const Camera& camera : scene.cameras) {
    const glm::dmat3 turn(camera.world_from_eye);
    const glm::dmat3 identity = glm::transpose(turn) * turn;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(identity[i][j], i == j, 1e-12) << camera.name;
    EXPECT_NEAR(glm::determinant(turn), 1, 1e-12) << camera.name;
    const glm::dvec3 to_centre = glm::dvec3(bounds.centre()) - glm::dvec3(camera.world_from_eye[3]);
    EXPECT_GT(glm::dot(glm::normalize(to_centre), -turn[2]), 0.8) << camera.name;
  }
}

std::uint64_t hash_bytes(std::uint64_t hash, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001B3u;
  return hash;
}

template <class T>
std::uint64_t hash_all(std::uint64_t hash, const std::vector<T>& values) {
  return hash_bytes(hash, values.data(), values.size() * sizeof(T));
}

// FNV-1a of everything that decides a picture. If the number changes, every stored picture of that scene is out of
// date: state the change in the commit.
std::uint64_t content_of(const Scene& scene) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const Mesh& mesh : scene.meshes) {
    hash = hash_all(hash, mesh.positions);
    hash = hash_all(hash, mesh.triangles);
    hash = hash_all(hash, mesh.normals.values);
    hash = hash_all(hash, mesh.texcoords.values);
    hash = hash_all(hash, mesh.material_ids);
  }
  for (const Instance& instance : scene.instances)
    hash = hash_bytes(hash, &instance.world_from_mesh, sizeof instance.world_from_mesh);
  for (const Material& material : scene.materials)
    hash = hash_bytes(hash, &material.base_color, sizeof material.base_color);
  for (const Texture& texture : scene.textures) hash = hash_all(hash, texture.pixels);
  return hash;
}

TEST_P(Builtin, IsTheSameOnEveryMachine) {
  const std::map<std::string_view, std::uint64_t> expected{
      {"teapot", 0x13DFA47E5017FA0Au}, {"cubes", 0x228F1178B784F1DAu},   {"cycle", 0xFC987C6B7B27510Eu},
      {"city", 0x69194A6B95FEE69Eu},   {"spheres", 0x95FB368264B30E6Au}, {"gallery", 0x1BAA8F8BEEE9A86Eu}};
  EXPECT_EQ(content_of(scene), expected.at(GetParam())) << std::hex << "0x" << content_of(scene);
  EXPECT_EQ(content_of(scene), content_of(builtin(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(All, Builtin, testing::ValuesIn(builtin_names().begin(), builtin_names().end()),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(BuiltinNames, AnUnknownOneIsAnErrorThatNamesTheKnown) {
  try {
    (void)builtin("rabbit");
    FAIL() << "made a rabbit";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    for (const std::string_view name : builtin_names())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << name;
    EXPECT_EQ(std::string(error.what()).rfind("builtin:rabbit: ", 0), 0u);
  }
}

}  // namespace
}  // namespace frontmost
