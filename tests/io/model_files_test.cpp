// SPDX-License-Identifier: Apache-2.0
// Models are saved and loaded again: the same triangles at the same places, what each format holds besides, and what
// every format refuses.
#include <gmock/gmock.h>

#include <filesystem>

#include "frontmost/files.h"
#include "frontmost/scene.h"
#include "support/scratch_folder.h"

namespace frontmost::test {
namespace {

class ModelFiles : public testing::Test {
 protected:
  ModelFiles() {
    Mesh mesh;
    mesh.name = "wedge";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}};
    mesh.texcoords.values = {{0, 0}, {1, 0}, {0, 1}};
    mesh.texcoords.triangles = {{0, 1, 2}, {0, 2, 1}, {1, 1, 2}};
    mesh.material_ids = {1, no_index, 1};
    scene_.meshes.push_back(mesh);
    scene_.materials.resize(2);
    scene_.instances.push_back({"as it is", 0, glm::dmat4(1.0)});
    scene_.instances.push_back({"mirrored", 0, glm::dmat4(1.0)});
    scene_.instances[1].world_from_mesh[0][0] = -2;
    scene_.instances[1].world_from_mesh[3] = {5, 6, 7, 1};
  }
  [[nodiscard]] std::string path(const std::string& suffix) const { return folder_.file("model" + suffix); }
  /// Vertices of all triangles in order; triangles of mirrored objects are wound as they face.
  static std::vector<std::array<glm::vec3, 3>> triangles_of(const Scene& scene) {
    const Surfaces surfaces(scene);
    std::vector<std::array<glm::vec3, 3>> all;
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      auto corners = surfaces.corners(id);
      if (surfaces.is_mirrored(surfaces.source(id).instance)) std::swap(corners[1], corners[2]);
      for (glm::vec3& corner : corners) corner = glm::vec3(glm::dvec3(corner) + scene.origin);
      all.push_back(corners);
    }
    return all;
  }

  Scene scene_;
  const test::ScratchFolder folder_;
};

TEST_F(ModelFiles, HoldTheSameTriangles) {
  const auto expected = triangles_of(scene_);
  for (const char* suffix : {".ply", ".stl"}) {
    save(scene_, path(suffix));
    EXPECT_EQ(triangles_of(load(path(suffix))), expected) << suffix;
  }
}

TEST_F(ModelFiles, AGlbHoldsObjectsMaterialsAndTextures) {
  Texture texture;
  texture.name = "dots";
  texture.width = 2, texture.height = 1;
  texture.pixels = {{255, 0, 0, 255}, {0, 10, 20, 0}};
  texture.wrap_u = Texture::Wrap::mirror;
  scene_.textures.push_back(texture);
  Material& material = scene_.materials[1];
  material.name = "red";
  material.base_color = {0.5f, 0.25f, 0.125f, 0.75f};
  material.base_color_texture = {0, {0.5f, 0}, {2, 1}, 0.25f, 0};
  material.metallic = 1;
  material.emissive = {4, 2, 0};
  material.alpha = Material::Alpha::mask;
  material.alpha_cutoff = 0.25f;
  material.double_sided = true;
  material.clearcoat = {0.5f, {}, 0.25f, {}, {}, 1};
  material.transmission.factor = 0.5f;
  material.ior = 1.25f;
  save(scene_, path(".glb"));
  const Scene again = load(path(".glb"));
  ASSERT_EQ(again.instances.size(), 2u);
  EXPECT_EQ(again.instances[1].name, "mirrored");
  EXPECT_EQ(again.instances[1].world_from_mesh, scene_.instances[1].world_from_mesh);
  EXPECT_EQ(again.instances[0].mesh, again.instances[1].mesh);
  const Mesh& mesh = again.meshes[again.instances[0].mesh];
  ASSERT_EQ(mesh.triangles.size(), 3u);
  const Material* found = nullptr;
  for (std::uint32_t t = 0; t < 3; ++t)
    if (const Material& one = again.materials[mesh.material_of(t)]; one.name == "red") found = &one;
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->base_color, material.base_color);
  EXPECT_EQ(found->base_color_texture.offset, material.base_color_texture.offset);
  EXPECT_EQ(found->base_color_texture.scale, material.base_color_texture.scale);
  EXPECT_EQ(found->base_color_texture.rotation, material.base_color_texture.rotation);
  EXPECT_EQ(found->metallic, 1);
  EXPECT_EQ(found->emissive, material.emissive);
  EXPECT_EQ(found->alpha, Material::Alpha::mask);
  EXPECT_EQ(found->alpha_cutoff, 0.25f);
  EXPECT_TRUE(found->double_sided);
  EXPECT_EQ(found->clearcoat.factor, 0.5f);
  EXPECT_EQ(found->clearcoat.roughness, 0.25f);
  EXPECT_EQ(found->transmission.factor, 0.5f);
  EXPECT_EQ(found->ior, 1.25f);
  ASSERT_EQ(again.textures.size(), 1u);
  EXPECT_EQ(again.textures[0].pixels, texture.pixels);
  EXPECT_EQ(again.textures[0].wrap_u, Texture::Wrap::mirror);
}

TEST_F(ModelFiles, CornersKeepTheirTextureCoordinatesInGlb) {
  scene_.meshes[0].material_ids.clear();  // one part, so that triangles keep their order
  save(scene_, path(".glb"));
  const Scene again = load(path(".glb"));
  const Mesh &mesh = again.meshes[0], &original = scene_.meshes[0];
  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (std::uint32_t t = 0; t < 3; ++t)
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.positions[mesh.triangles[t][k]], original.positions[original.triangles[t][k]]);
      EXPECT_EQ(mesh.texcoords.values[mesh.corners(mesh.texcoords, t)[k]],
                original.texcoords.values[original.texcoords.triangles[t][k]]);
    }
}

TEST_F(ModelFiles, LieWhereTheModelLayAndStandUprightInGlb) {
  scene_.meshes[0].material_ids.clear();
  scene_.up = Axis::z;
  scene_.origin = {4e6, 5e5, 0};
  save(scene_, path(".ply"));
  const Scene cloud = load(path(".ply"), {.format = {}, .up = Axis::z});
  EXPECT_EQ(triangles_of(cloud), triangles_of(scene_));
  EXPECT_EQ(cloud.origin + glm::dvec3(cloud.meshes[0].positions[1]), glm::dvec3(4e6 + 1, 5e5, 0));
  save(scene_, path(".glb"));
  const Scene turned = load(path(".glb"));
  // A point (x, y, z) with z up becomes (x, z, -y) with y up.
  const glm::dvec4 corner(scene_.meshes[0].positions[3], 1);
  const glm::dvec3 before = scene_.origin + glm::dvec3(scene_.instances[1].world_from_mesh * corner);
  const glm::dvec4 same(turned.meshes[turned.instances[1].mesh].positions.back(), 1);
  EXPECT_EQ(glm::vec3(same), scene_.meshes[0].positions[3]);
  const glm::dvec3 after = turned.origin + glm::dvec3(turned.instances[1].world_from_mesh * same);
  EXPECT_NEAR(glm::distance(after, glm::dvec3(before.x, before.z, -before.y)), 0, 1e-9);
}

TEST_F(ModelFiles, APlyHoldsNumbersOfItsFaces) {
  const Table table{{{"red", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}},
                     {"object", std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1}},
                     {"pixels", std::vector<double>{0.5, 1, 1.5, 2, 2.5, 3}}}};
  save(scene_, path(".ply"), table);
  const std::string bytes = load_text(path(".ply"), 1 << 16);
  EXPECT_THAT(bytes, testing::HasSubstr("property list uchar uint vertex_indices\nproperty uchar red\n"
                                        "property uint object\nproperty double pixels\nend_header\n"));
  const double last = 3;
  EXPECT_EQ(bytes.substr(bytes.size() - 8), std::string(reinterpret_cast<const char*>(&last), 8));
  EXPECT_EQ(triangles_of(load(path(".ply"))), triangles_of(scene_));
}

TEST_F(ModelFiles, OfNothingAreRead) {
  for (const char* suffix : {".ply", ".stl", ".glb"}) {
    save(Scene(), path(suffix));
    EXPECT_EQ(triangle_count(load(path(suffix))), 0u) << suffix;
  }
}

TEST_F(ModelFiles, WhatCannotBeWrittenIsRefusedAndLeavesNothing) {
  const Table table{{{"pixels", std::vector<double>(6)}}}, short_one{{{"pixels", std::vector<double>(5)}}};
  EXPECT_THROW(save(scene_, path(".stl"), table), Error);
  EXPECT_THROW(save(scene_, path(".ply"), short_one), Error);
  EXPECT_THROW(save(scene_, path(".obj")), Error);
  scene_.meshes[0].triangles[0].x = 9;
  EXPECT_THROW(save(scene_, path(".glb")), Error);
  for (const char* suffix : {".ply", ".stl", ".glb"}) EXPECT_FALSE(std::filesystem::exists(path(suffix)));
}

}  // namespace
}  // namespace frontmost::test
