// SPDX-License-Identifier: Apache-2.0
// Layers of glTF materials, and sets of texture coordinates.
#include <gmock/gmock.h>

#include "io/image_bytes.h"
#include "io/models/gltf_maker.h"

namespace frontmost {
namespace {

using test::GltfMaker;
using test::load_glb;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

constexpr float infinite = std::numeric_limits<float>::infinity();

/// A triangle with `sets` sets of texture coordinates, where set k begins at (k, k). Textures 0 to 2 show an image,
/// textures 3 and 4 nothing.
GltfMaker layered_maker(int sets) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string attributes = R"("POSITION":0)";
  for (int set = 0; set < sets; ++set) {
    const auto start = float(set);
    const int accessor = maker.floats({start, start, start + 1, start, start, start + 1}, "VEC2");
    attributes += R"(,"TEXCOORD_)" + std::to_string(set) + R"(":)" + std::to_string(accessor);
  }
  const std::vector<std::byte> png = test::encode_png({}, std::vector<std::uint8_t>{255, 0, 0, 255});
  const int view = maker.view(png.data(), png.size());
  maker.add("images", R"({"mimeType":"image/png","bufferView":)" + std::to_string(view) + "}");
  maker.add("images", R"({"uri":"nowhere.png"})");
  for (int i = 0; i < 3; ++i) maker.add("textures", R"({"source":0})");
  maker.add("textures", R"({"source":1})");
  maker.add("textures", "{}");
  maker.show(R"({"attributes":{)" + attributes + R"(},"material":0})");
  return maker;
}

Scene with_material(GltfMaker maker, const std::string& json) {
  maker.add("materials", json);
  return load_glb(maker);
}
/// A scene whose material has these extensions.
Scene with_layers(const std::string& extensions) {
  return with_material(layered_maker(1), R"({"name":"m","extensions":{)" + extensions + "}}");
}

TEST(GltfTexcoords, EveryTextureKeepsItsSet) {
  const Scene scene = with_material(layered_maker(4), R"({"pbrMetallicRoughness":{
      "baseColorTexture":{"index":0,"texCoord":1},
      "metallicRoughnessTexture":{"index":1,"texCoord":2,"extensions":{"KHR_texture_transform":{"texCoord":3}}}},
      "emissiveTexture":{"index":0,"texCoord":0}})");
  EXPECT_THAT(scene.warnings, SizeIs(0));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color_texture.set, 1u);
  EXPECT_EQ(m.metallic_roughness_texture.set, 3u) << "the transform's own set counts";
  EXPECT_EQ(m.emissive_texture.set, 0u);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.texcoords.values.at(0), glm::vec2(0));
  ASSERT_THAT(mesh.further_texcoords, SizeIs(3));
  EXPECT_EQ(mesh.further_texcoords[0].values.at(0), glm::vec2(1));
  EXPECT_TRUE(mesh.further_texcoords[1].empty()) << "no texture uses set 2";
  EXPECT_EQ(mesh.further_texcoords[2].values.at(2), glm::vec2(3, 4));
  EXPECT_EQ(mesh.texcoord_set(2), nullptr);
  EXPECT_EQ(mesh.texcoord_set(3), &mesh.further_texcoords[2]);
  EXPECT_EQ(mesh.texcoord_set(4), nullptr);
}

TEST(GltfTexcoords, SetsThatNobodyUsesAreNotRead) {
  const Scene scene = with_material(layered_maker(4), R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_THAT(scene.meshes.at(0).further_texcoords, SizeIs(0));
  EXPECT_FALSE(scene.meshes[0].texcoords.empty());
}

TEST(GltfTexcoords, ASetTooManyIsLeftOut) {
  const Scene scene = with_material(layered_maker(4),
                                    R"({"name":"m","emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":4},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":18446744073709551615}}})");
  EXPECT_FALSE(scene.materials.at(0).base_color_texture.is_set());
  EXPECT_EQ(scene.materials[0].emissive, glm::vec3(0));
  EXPECT_THAT(scene.warnings, Contains("t.glb: materials[0].emissiveTexture: uses texture coordinates 4, of which only "
                                       "4 sets are read; the texture is left out"));
  EXPECT_THAT(scene.warnings,
              Contains(HasSubstr("m): the emissive texture is missing, so the material does not glow")));
}

TEST(GltfTexcoords, ASetThatIsNotThereIsTold) {
  const Scene scene =
      with_material(layered_maker(1), R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}})");
  ASSERT_THAT(scene.warnings, SizeIs(1));
  EXPECT_THAT(scene.warnings[0], HasSubstr("meshes[0].primitives[0]: has no TEXCOORD_1"));
  EXPECT_EQ(scene.meshes.at(0).texcoord_set(1), nullptr);
}

// Primitives of one mesh may use different sets. Missing coordinates are 0, and morph targets move every set.
TEST(GltfTexcoords, PrimitivesShareTheSetsOfTheirMesh) {
  GltfMaker maker = layered_maker(2);
  const int moved = maker.floats({10, 10, 10, 10, 10, 10}, "VEC2");
  maker.add("meshes", R"({"weights":[0.5],"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2},
      "material":0,"targets":[{"TEXCOORD_1":)" +
                          std::to_string(moved) + R"(}]},
      {"attributes":{"POSITION":0,"TEXCOORD_0":1},"targets":[{"TEXCOORD_0":)" +
                          std::to_string(moved) + "}]}]}");
  maker.add("nodes", R"({"mesh":1})");
  const Scene scene = with_material(maker, R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}})");
  const Mesh& mesh = scene.meshes.at(1);
  ASSERT_THAT(mesh.further_texcoords, SizeIs(1));
  ASSERT_THAT(mesh.further_texcoords[0].values, SizeIs(6));
  EXPECT_EQ(mesh.further_texcoords[0].values[0], glm::vec2(6));
  EXPECT_EQ(mesh.further_texcoords[0].values[3], glm::vec2(0));
  EXPECT_EQ(mesh.texcoords.values[0], glm::vec2(0));
  EXPECT_EQ(mesh.texcoords.values[3], glm::vec2(5));
}

TEST(GltfLayers, ByDefaultThereAreNone) {
  const Scene scene = with_layers(R"("KHR_materials_specular":{},"KHR_materials_ior":{},"KHR_materials_clearcoat":{},
      "KHR_materials_sheen":{},"KHR_materials_transmission":{},"KHR_materials_volume":{})");
  EXPECT_THAT(scene.warnings, SizeIs(0));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular.factor, 1.0f);
  EXPECT_EQ(m.specular.color, glm::vec3(1));
  EXPECT_EQ(m.clearcoat.factor, 0.0f);
  EXPECT_EQ(m.clearcoat.normal_scale, 1.0f);
  EXPECT_EQ(m.sheen.color, glm::vec3(0));
  EXPECT_EQ(m.transmission.factor, 0.0f);
  EXPECT_EQ(m.volume.thickness, 0.0f);
  EXPECT_EQ(m.volume.attenuation_distance, infinite);
  EXPECT_EQ(m.volume.attenuation_color, glm::vec3(1));
  EXPECT_FALSE(m.is_see_through());
  for (const TextureUse* use : texture_uses_of(m)) EXPECT_FALSE(use->is_set());
}

TEST(GltfLayers, AllMembersAreRead) {
  const Scene scene = with_layers(R"("KHR_materials_ior":{"ior":2.5},
      "KHR_materials_specular":{"specularFactor":0.25,"specularTexture":{"index":0},
        "specularColorFactor":[0.5,2,0],"specularColorTexture":{"index":1}},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatTexture":{"index":0},"clearcoatRoughnessFactor":0.125,
        "clearcoatRoughnessTexture":{"index":0},"clearcoatNormalTexture":{"index":0,"scale":3}},
      "KHR_materials_sheen":{"sheenColorFactor":[1,0.5,0.25],"sheenColorTexture":{"index":0},
        "sheenRoughnessFactor":0.375,"sheenRoughnessTexture":{"index":0}},
      "KHR_materials_transmission":{"transmissionFactor":0.875,"transmissionTexture":{"index":0}},
      "KHR_materials_volume":{"thicknessFactor":7,"thicknessTexture":{"index":0},"attenuationDistance":0.5,
        "attenuationColor":[0.5,0.25,1]})");
  ASSERT_THAT(scene.warnings, SizeIs(1));
  EXPECT_EQ(
      scene.warnings[0],
      "t.glb: KHR_materials_transmission: light passes straight through; rough glass does not blur, and thick glass "
      "does not refract");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.ior, 2.5f);
  EXPECT_EQ(m.specular.factor, 0.25f);
  EXPECT_EQ(m.specular.color, glm::vec3(0.5f, 2, 0));
  EXPECT_EQ(m.clearcoat.factor, 0.75f);
  EXPECT_EQ(m.clearcoat.roughness, 0.125f);
  EXPECT_EQ(m.clearcoat.normal_scale, 3.0f);
  EXPECT_EQ(m.sheen.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(m.sheen.roughness, 0.375f);
  EXPECT_EQ(m.transmission.factor, 0.875f);
  EXPECT_EQ(m.volume.thickness, 7.0f);
  EXPECT_EQ(m.volume.attenuation_distance, 0.5f);
  EXPECT_EQ(m.volume.attenuation_color, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_TRUE(m.is_see_through());
  int set = 0;
  for (const TextureUse* use : texture_uses_of(m)) set += use->is_set();
  EXPECT_EQ(set, 9);
}

TEST(GltfLayers, NumbersOutOfRangeAreToldAndLimited) {
  const Scene scene = with_layers(R"("KHR_materials_ior":{"ior":0.5},
      "KHR_materials_specular":{"specularFactor":-1,"specularColorFactor":[-1,1e30,2]},
      "KHR_materials_clearcoat":{"clearcoatFactor":1e300,"clearcoatRoughnessFactor":2},
      "KHR_materials_sheen":{"sheenColorFactor":[2,0,-1],"sheenRoughnessFactor":-0.5},
      "KHR_materials_transmission":{"transmissionFactor":3},
      "KHR_materials_volume":{"thicknessFactor":-2,"attenuationDistance":0,"attenuationColor":[1,-1,9]})");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.ior, 1.0f);
  EXPECT_EQ(m.specular.factor, 0.0f);
  EXPECT_EQ(m.specular.color, glm::vec3(0, 1e12f, 2));
  EXPECT_EQ(m.clearcoat.factor, 1.0f);
  EXPECT_EQ(m.clearcoat.roughness, 1.0f);
  EXPECT_EQ(m.sheen.color, glm::vec3(1, 0, 0));
  EXPECT_EQ(m.sheen.roughness, 0.0f);
  EXPECT_EQ(m.transmission.factor, 1.0f);
  EXPECT_EQ(m.volume.thickness, 0.0f);
  EXPECT_GT(m.volume.attenuation_distance, 0.0f);
  EXPECT_EQ(m.volume.attenuation_color, glm::vec3(1, 0, 1));
  EXPECT_THAT(scene.warnings, SizeIs(12));
  EXPECT_THAT(
      scene.warnings,
      Contains("t.glb: materials[0] (m): transmissionFactor is out of range; the nearest value in range is used"));
  EXPECT_EQ(with_layers(R"("KHR_materials_ior":{"ior":0})").materials.at(0).ior, 0.0f) << "a mirror";
  EXPECT_THAT(with_layers(R"("KHR_materials_ior":{"ior":0})").warnings, SizeIs(0));
}

TEST(GltfLayers, NumbersOfTheMaterialItselfAreToldAndLimited) {
  const Scene scene = with_material(layered_maker(1), R"({"name":"m","emissiveFactor":[-1,1e300,2],
      "occlusionTexture":{"index":0,"strength":3},
      "pbrMetallicRoughness":{"baseColorFactor":[2,0.5,-1,3],"metallicFactor":-1,"roughnessFactor":9}})");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color, glm::vec4(1, 0.5f, 0, 1));
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.emissive, glm::vec3(0, 1e12f, 2));
  EXPECT_EQ(m.occlusion_strength, 1.0f);
  EXPECT_THAT(scene.warnings, SizeIs(5)) << "each told once";
  EXPECT_THAT(
      scene.warnings,
      Contains(
          "t.glb: materials[0] (m): occlusionTexture.strength is out of range; the nearest value in range is used"));
}

// A factor is the maximum that its texture scales down: without the texture, a model with one window would be all
// glass.
TEST(GltfLayers, ALayerIsNotThereWithoutItsTexture) {
  for (const int texture : {3, 4}) {
    const std::string use = R"({"index":)" + std::to_string(texture) + "}";
    const Scene scene =
        with_layers(R"("KHR_materials_specular":{"specularFactor":0.5,"specularTexture":)" + use +
                    R"(},"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatRoughnessTexture":)" + use +
                    R"(},"KHR_materials_sheen":{"sheenColorFactor":[1,1,1],"sheenColorTexture":)" + use +
                    R"(},"KHR_materials_transmission":{"transmissionFactor":1,
                                      "transmissionTexture":)" +
                    use + R"(},"KHR_materials_volume":{"thicknessFactor":1,"thicknessTexture":)" + use + "}");
    const Material& m = scene.materials.at(0);
    for (const TextureUse* t : texture_uses_of(m)) EXPECT_FALSE(t->is_set());
    EXPECT_EQ(m.specular.factor, 1.0f);
    EXPECT_EQ(m.clearcoat.factor, 0.0f);
    EXPECT_EQ(m.sheen.color, glm::vec3(0));
    EXPECT_EQ(m.volume.thickness, 0.0f);
    EXPECT_FALSE(m.is_see_through());
    EXPECT_THAT(scene.warnings, Contains("t.glb: materials[0] (m): has no transmission without its texture"));
  }
  // A missing bump texture only loses the bumps.
  const Scene scene =
      with_layers(R"("KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":3}})");
  EXPECT_EQ(scene.materials.at(0).clearcoat.factor, 1.0f);
  EXPECT_FALSE(scene.materials[0].clearcoat.normal_texture.is_set());
}

// The texture gave the mirror its colour; without it a white mirror would hide the base.
TEST(GltfLayers, SpecularAndGlossinessWithoutItsTextureIsNoMirror) {
  const Scene scene = with_layers(R"("KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":0.75,
      "specularGlossinessTexture":{"index":3}})");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.specular.color, glm::vec3(1));
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_THAT(scene.warnings, Contains("t.glb: materials[0] (m): has no specular layer without its texture"));
}

// Converted as by Khronos' own tools: a mirror of the specular colour over a matt base.
TEST(GltfLayers, SpecularAndGlossinessAreAMirrorOverAMattBase) {
  const Scene scene = with_material(layered_maker(1), R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],
      "metallicRoughnessTexture":{"index":0}},"extensions":{"KHR_materials_pbrSpecularGlossiness":{
      "diffuseFactor":[0.5,0.25,0,0.75],"diffuseTexture":{"index":1},"specularFactor":[0.125,0.25,0.5],
      "glossinessFactor":0.75,"specularGlossinessTexture":{"index":2}}}})");
  EXPECT_THAT(scene.warnings, SizeIs(0));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color, glm::vec4(0.5f, 0.25f, 0, 0.75f));
  EXPECT_TRUE(m.base_color_texture.is_set());
  EXPECT_FALSE(m.metallic_roughness_texture.is_set());
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.ior, 0.0f);
  EXPECT_EQ(m.specular.color, glm::vec3(0.125f, 0.25f, 0.5f));
  EXPECT_TRUE(m.specular.color_texture.is_set());
}

TEST(GltfLayers, WhatIsNotDoneIsNamedOnce) {
  GltfMaker maker = layered_maker(1);
  maker.set("extensionsUsed", R"(["KHR_materials_anisotropy","KHR_materials_clearcoat","KHR_materials_iridescence"])");
  for (int i = 0; i < 3; ++i)
    maker.add("materials", R"({"extensions":{"KHR_materials_anisotropy":{},"KHR_materials_clearcoat":{}}})");
  const Scene scene = load_glb(maker);
  ASSERT_THAT(scene.warnings, SizeIs(2));
  EXPECT_EQ(scene.warnings[0], "t.glb: extensionsUsed: KHR_materials_anisotropy is not supported, and ignored");
  EXPECT_THAT(scene.warnings[1], HasSubstr("KHR_materials_iridescence"));
}

TEST(GltfLayers, WhatIsBlackWithoutIridescenceIsNamed) {
  const std::string film = R"("extensions":{"KHR_materials_iridescence":{"iridescenceFactor":1}})";
  const std::string black = R"("pbrMetallicRoughness":{"baseColorFactor":[0,0,0.01,1]},)";
  GltfMaker maker = layered_maker(1);
  maker.add("materials", R"({"name":"beetle",)" + black + film + "}");
  maker.add("materials", "{" + film + "}");
  maker.add("materials", R"({"emissiveFactor":[1,0,0],)" + black + film + "}");
  maker.add("materials", "{" + black + R"("extensions":{"KHR_materials_iridescence":{}}})");
  const Scene scene = load_glb(maker);
  ASSERT_THAT(scene.warnings, SizeIs(1));
  EXPECT_THAT(scene.warnings[0], HasSubstr("(beetle): is drawn black: its colours are those of "
                                           "KHR_materials_iridescence, which is not read"));
}

}  // namespace
}  // namespace frontmost
