// SPDX-License-Identifier: Apache-2.0
// Materials and textures of glTF files.
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "frontmost/files.h"
#include "io/image_bytes.h"
#include "io/models/gltf_maker.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;
using test::GltfMaker;
using test::load_glb;
using testing::HasSubstr;
using testing::SizeIs;

std::vector<std::byte> red_png() { return test::encode_png({}, std::vector<std::uint8_t>{255, 0, 0, 255}); }

/// A triangle with two sets of texture coordinates, and an image.
GltfMaker textured_maker() {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  maker.floats({5, 5, 6, 5, 5, 6}, "VEC2");
  const std::vector<std::byte> png = red_png();
  const int view = maker.view(png.data(), png.size());
  maker.add("images", R"({"mimeType":"image/png","name":"red","bufferView":)" + std::to_string(view) + "}");
  maker.add("textures", R"({"source":0})");
  maker.show(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2},"material":0})");
  return maker;
}

TEST(GltfMaterials, AllMembersAreRead) {
  GltfMaker maker = textured_maker();
  maker.add("materials", R"({"name":"m","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
      "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.75,
        "baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[1,2],"scale":[3,4],"rotation":5}}},
        "metallicRoughnessTexture":{"index":0}},
      "normalTexture":{"index":0,"scale":2},"occlusionTexture":{"index":0,"strength":0.5},
      "emissiveTexture":{"index":0},"emissiveFactor":[0.5,1,0],
      "extensions":{"KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":4}}})");
  const Scene scene = load_glb(maker);
  EXPECT_THAT(scene.warnings, SizeIs(0));
  ASSERT_THAT(scene.textures, SizeIs(1));
  EXPECT_EQ(scene.textures[0].name, "red");
  EXPECT_EQ(scene.textures[0].pixels.at(0), glm::u8vec4(255, 0, 0, 255));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.75f);
  EXPECT_EQ(m.base_color_texture.offset, glm::vec2(1, 2));
  EXPECT_EQ(m.base_color_texture.scale, glm::vec2(3, 4));
  EXPECT_EQ(m.base_color_texture.rotation, 5.0f);
  for (const TextureUse* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                &m.occlusion_texture, &m.emissive_texture})
    EXPECT_EQ(use->texture, 0u);
  EXPECT_EQ(m.normal_scale, 2.0f);
  EXPECT_EQ(m.occlusion_strength, 0.5f);
  EXPECT_EQ(m.emissive, glm::vec3(2, 4, 0));
  EXPECT_EQ(m.alpha, Material::Alpha::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(m.unlit);
}

TEST(GltfMaterials, DefaultsAreThoseOfTheFormat) {
  GltfMaker maker = textured_maker();
  maker.add("materials", "{}");
  const Material m = load_glb(maker).materials.at(0);
  EXPECT_EQ(m.base_color, glm::vec4(1));
  EXPECT_EQ(m.metallic, 1.0f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.alpha, Material::Alpha::opaque);
  EXPECT_EQ(m.alpha_cutoff, 0.5f);
  EXPECT_FALSE(m.double_sided);
  EXPECT_FALSE(m.base_color_texture.is_set());
}

/// Checks a material that lost all textures but its base colour texture, and the warnings.
void expect_no_glow_and_no_metal(const Scene& scene, const std::string& who) {
  const Material& m = scene.materials.at(0);
  for (const TextureUse* use :
       {&m.metallic_roughness_texture, &m.normal_texture, &m.occlusion_texture, &m.emissive_texture})
    EXPECT_FALSE(use->is_set());
  EXPECT_EQ(m.emissive, glm::vec3(0)) << "white on white";
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.roughness, 0.75f);
  EXPECT_THAT(scene.warnings,
              testing::Contains("t.glb: " + who + ": the emissive texture is missing, so the material does not glow"));
  EXPECT_THAT(scene.warnings,
              testing::Contains("t.glb: " + who +
                                ": its metallic-roughness texture is missing, so the material is not metallic"));
}

// An emissive factor is usually white and its texture mostly black: without the texture the glow would outshine all
// else.
TEST(GltfMaterials, WhatATextureLimitsIsNotThereWithoutIt) {
  const auto members = [](const std::string& use) {
    return R"("metallicFactor":1,"roughnessFactor":0.75,"metallicRoughnessTexture":)" + use + R"(},"normalTexture":)" +
           use + R"(,"occlusionTexture":)" + use + R"(,"emissiveTexture":)" + use + R"(,"emissiveFactor":[1,1,1]})";
  };
  GltfMaker other_set = textured_maker();
  other_set.add("materials", R"({"name":"lamp","pbrMetallicRoughness":{"baseColorTexture":{"index":0},)" +
                                 members(R"({"index":0,"texCoord":9})"));
  expect_no_glow_and_no_metal(load_glb(other_set), "materials[0] (lamp)");
  EXPECT_TRUE(load_glb(other_set).materials[0].base_color_texture.is_set());

  // One image cannot be decoded, which is found last of all; one texture has no image.
  for (const char* texture : {R"({"source":1})", "{}"}) {
    GltfMaker broken = textured_maker();
    broken.add("images", R"({"uri":"nowhere.png"})");
    broken.add("textures", texture);
    broken.add("materials", R"({"pbrMetallicRoughness":{)" + members(R"({"index":1})"));
    expect_no_glow_and_no_metal(load_glb(broken), "materials[0]");
  }
}

TEST(GltfMaterials, ImagesAreSharedUnlessSamplersDiffer) {
  GltfMaker maker = textured_maker();
  maker.add("samplers", R"({"wrapS":33071,"wrapT":33648,"magFilter":9728})");
  maker.add("samplers", R"({"wrapS":10497})");
  maker.add("textures", R"({"source":0,"sampler":0})");
  maker.add("textures", R"({"source":0,"sampler":1})");
  for (int i = 0; i < 3; ++i)
    maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(i) + "}}}");
  const Scene scene = load_glb(maker);
  ASSERT_THAT(scene.textures, SizeIs(2)) << "an explicit repeat is the default";
  EXPECT_EQ(scene.materials[0].base_color_texture.texture, scene.materials[2].base_color_texture.texture);
  const Texture& clamped = scene.textures[scene.materials[1].base_color_texture.texture];
  EXPECT_EQ(clamped.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(clamped.wrap_v, Texture::Wrap::mirror);
  EXPECT_TRUE(clamped.nearest);
  EXPECT_THAT(clamped.pixels, SizeIs(1));
  EXPECT_THAT(scene.textures[scene.materials[0].base_color_texture.texture].pixels, SizeIs(1));
}

// Two identical images at one place are one; its pixels count once for each sampler that uses them.
TEST(GltfMaterials, ImagesThatGrowTooMuchAreLeftOut) {
  for (const int sampler_count : {1, 2}) {
    GltfMaker maker;
    // The image takes half of the free allowance of pixels, in a few thousand bytes.
    const test::PngFlavour flavour{.width = 8192, .height = 6144, .color_type = 0, .bits = 1};
    const std::vector<std::byte> png = test::encode_png(flavour, std::vector<std::uint8_t>(1024 * 6144));
    ASSERT_LT(png.size(), 10'000u);
    const int view = maker.view(png.data(), png.size());
    maker.add("samplers", R"({"wrapS":10497})");
    maker.add("samplers", R"({"wrapS":33071})");
    for (int i = 0; i < 2; ++i) {
      maker.add("images", R"({"bufferView":)" + std::to_string(view) + "}");
      maker.add("textures", R"({"source":0,"sampler":)" + std::to_string(i % sampler_count) + "}");
      maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(i) + "}}}");
    }
    const Scene scene = load_glb(maker);
    EXPECT_THAT(scene.textures, SizeIs(sampler_count == 1 ? 1 : 0));
    if (sampler_count == 2) {
      EXPECT_THAT(scene.warnings.at(0), HasSubstr("images[0]: too many pixels"));
    }
  }
}

TEST(GltfMaterials, ImagesThatLieInOnePlaceAreReadOnce) {
  GltfMaker maker = textured_maker();
  maker.add("bufferViews", R"({"buffer":0,"byteOffset":84,"byteLength":)" + std::to_string(red_png().size()) + "}");
  maker.add("images", R"({"name":"again","bufferView":4})");
  maker.add("textures", R"({"source":1})");
  for (int i = 0; i < 2; ++i)
    maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(i) + "}}}");
  const Scene scene = load_glb(maker);
  EXPECT_THAT(scene.warnings, SizeIs(0));
  ASSERT_THAT(scene.textures, SizeIs(2));
  EXPECT_EQ(scene.textures[1].name, "red");
  EXPECT_EQ(scene.textures[0].pixels, scene.textures[1].pixels);
}

TEST(GltfMaterials, ImagesThatCannotBeReadAreWarnings) {
  GltfMaker maker = textured_maker();
  maker.add("images", R"({"uri":"data:image/webp;base64,UklGRgAAAABXRUJQVlA4IA=="})");
  maker.add("images", R"({"uri":"nowhere.png"})");
  maker.add("images", R"({"bufferView":99})");
  maker.add("textures", R"({"source":1})");
  maker.add("textures", R"({"source":2})");
  maker.add("textures", R"({"source":3})");
  maker.add("textures", R"({"extensions":{"KHR_texture_basisu":{"source":0}}})");
  // The good image is used last, so that its number changes.
  for (const int i : {1, 2, 3, 4, 0})
    maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(i) + "}}}");
  const Scene scene = load_glb(maker);
  ASSERT_THAT(scene.warnings, SizeIs(4));
  EXPECT_THAT(scene.warnings[0], HasSubstr("textures[4]: its image is KTX2, which is not read (convert it first: npx"));
  EXPECT_THAT(scene.warnings[1], testing::AllOf(HasSubstr("images[1]: "), HasSubstr("WebP"), HasSubstr("go without")));
  EXPECT_THAT(scene.warnings[2], HasSubstr("nowhere.png"));
  EXPECT_THAT(scene.warnings[3], HasSubstr("images[3].bufferView: 99"));
  ASSERT_THAT(scene.textures, SizeIs(1));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(scene.materials[std::size_t(i)].base_color_texture.is_set());
  EXPECT_EQ(scene.materials[4].base_color_texture.texture, 0u);
}

TEST(GltfMaterials, FilesBesideTheModelAreRead) {
  const fs::path folder = fs::temp_directory_path() / ("frontmost_gltf_" + std::to_string(getpid()));
  fs::create_directories(folder / "my textures");
  const auto write = [&](const fs::path& name, const std::vector<std::byte>& bytes) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  };
  GltfMaker maker = textured_maker();
  maker.add("images", R"({"uri":"my%20textures/red.png"})");
  maker.add("textures", R"({"source":1})");
  maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}})");
  write("my textures/red.png", red_png());
  write("data.bin", maker.binary());
  write("model.gltf", test::byte_vector(maker.json(R"(,"uri":"data.bin")")));
  const Scene scene = load((folder / "model.gltf").string());
  EXPECT_EQ(scene.name, "model");
  EXPECT_THAT(scene.warnings, SizeIs(0));
  EXPECT_EQ(triangle_count(scene), 1u);
  ASSERT_THAT(scene.textures, SizeIs(1));
  EXPECT_EQ(scene.textures[0].pixels.at(0), glm::u8vec4(255, 0, 0, 255));
  fs::remove_all(folder);
}

TEST(GltfMaterials, WrongReferencesAreErrors) {
  GltfMaker maker = textured_maker();
  maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":7}}})");
  try {
    (void)load_glb(maker);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("t.glb: materials[0].pbrMetallicRoughness.baseColorTexture.index: 7 does not exist"));
  }
}

/// Decodes bytes "SIZE width height" as a grey image of that size.
class GreyDecoder : public ImageDecoder {
 public:
  [[nodiscard]] glm::ivec2 size(std::span<const std::byte> file) const override {
    if (file.size() != 3) throw Error(ErrorCode::file_malformed, "not three bytes");
    return {int(file[1]) * scale, int(file[2])};
  }
  [[nodiscard]] Texture pixels(std::span<const std::byte> file) const override {
    Texture texture;
    texture.width = int(file[1]), texture.height = int(file[2]);
    texture.pixels.assign(std::size_t(texture.width) * std::size_t(texture.height), glm::u8vec4(7, 7, 7, 255));
    return texture;
  }
  int scale = 1;
};

/// Loads a triangle whose texture is in an encoding that the library does not know.
Scene load_by(const ImageDecoder* decoder, std::vector<std::byte> image) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  const int view = maker.view(image.data(), image.size());
  maker.add("images", R"({"mimeType":"image/grey","bufferView":)" + std::to_string(view) + "}");
  maker.add("textures", R"({"source":0})");
  maker.add("materials", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  maker.show(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0})");
  const std::vector<std::byte> bytes = maker.glb();
  return load(bytes, "grey.glb", {.format = {}, .up = {}, .image_decoder = decoder});
}

TEST(GltfMaterials, ImagesAreDecodedByTheCaller) {
  const std::vector<std::byte> image = {std::byte('S'), std::byte(3), std::byte(2)};
  GreyDecoder decoder;
  const Scene scene = load_by(&decoder, image);
  EXPECT_THAT(scene.warnings, SizeIs(0));
  ASSERT_THAT(scene.textures, SizeIs(1));
  EXPECT_EQ(scene.textures[0].width, 3);
  EXPECT_EQ(scene.textures[0].height, 2);
  EXPECT_EQ(scene.textures[0].pixels.at(5), glm::u8vec4(7, 7, 7, 255));
  // The library itself does not know this encoding.
  EXPECT_THAT(load_by(nullptr, image).warnings, testing::ElementsAre(HasSubstr("neither PNG nor JPEG nor WebP")));
}

TEST(GltfMaterials, WhatACallersDecoderRefusesOrGetsWrongIsTold) {
  GreyDecoder decoder;
  const Scene refused = load_by(&decoder, {std::byte('S'), std::byte(3), std::byte(2), std::byte(1)});
  EXPECT_THAT(refused.textures, SizeIs(0));
  EXPECT_THAT(refused.warnings, testing::ElementsAre(HasSubstr("grey.glb: images[0]: not three bytes")));
  decoder.scale = 2;
  EXPECT_THAT(load_by(&decoder, {std::byte('S'), std::byte(3), std::byte(2)}).warnings,
              testing::ElementsAre(HasSubstr("gave pixels of another size than it had stated")));
  decoder.scale = 1 << 20;
  EXPECT_THAT(load_by(&decoder, {std::byte('S'), std::byte(3), std::byte(2)}).warnings,
              testing::ElementsAre(HasSubstr("more than 16384 on a side")));
}

}  // namespace
}  // namespace frontmost
