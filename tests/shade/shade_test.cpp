// SPDX-License-Identifier: Apache-2.0
// Whole pictures of small scenes with known colours.
#include <gtest/gtest.h>

#include <cmath>

#include "base/srgb.h"
#include "frontmost/files.h"
#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/support.h"
#include "support/effort.h"
#include "support/odd_numbers.h"

namespace frontmost {
namespace {

using namespace test;

Image picture(const Scene& scene, const View& view, const ShadeOptions& options = {}, const Execution& execution = {}) {
  const Surfaces surfaces(scene);
  return shade(surfaces, zbuffer(surfaces, view), options, execution);
}

ShadeOptions with(Shading shading) { return {.shading = shading}; }

TEST(Shade, BackgroundIsWhiteByDefaultTransparentOnRequestAndAnyColour) {
  const Scene scene = scene_of(square());
  EXPECT_EQ(color_at(picture(scene, front_view()), 2, 2), glm::vec4(1));
  EXPECT_EQ(color_at(picture(scene, front_view(), {.background = std::nullopt}), 2, 2), glm::vec4(0));
  const glm::vec4 color = color_at(picture(scene, front_view(), {.background = glm::vec3(128 / 255.0f, 0, 1)}), 2, 2);
  EXPECT_EQ(srgb8_of_linear(color.r), 128);
  EXPECT_EQ(color.g, 0.0f);
  EXPECT_EQ(color.b, 1.0f);
  EXPECT_EQ(color.a, 1.0f);
}

TEST(Shade, AnEmptySceneIsAllBackground) {
  const Image image = picture(Scene{}, front_view(16, 4), {.background = std::nullopt});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) ASSERT_EQ(color_at(image, x, y), glm::vec4(0));
}

TEST(Shade, EdgesArePremultipliedCoverage) {
  // The square's left edge is at x = 16.5 of 64: with four samples, each column of a pixel has one sample.
  Scene scene = scene_of(square(), colored({1, 0, 0, 1}));
  scene.instances[0].world_from_mesh[3] = {0.5 / 16, 0, 0, 1};
  const Image image = picture(scene, front_view(64, 4), {.shading = Shading::flat, .background = std::nullopt});
  EXPECT_EQ(color_at(image, 15, 32), glm::vec4(0));
  EXPECT_EQ(color_at(image, 16, 32), glm::vec4(0.5f, 0, 0, 0.5f));
  EXPECT_EQ(color_at(image, 17, 32), glm::vec4(1, 0, 0, 1));
  const Image on_white = picture(scene, front_view(64, 4), with(Shading::flat));
  EXPECT_EQ(color_at(on_white, 16, 32), glm::vec4(1, 0.5f, 0.5f, 1));
}

TEST(Shade, FlatGivesEveryGreyOfATextureBack) {
  Material material;
  material.base_color_texture.texture = 0;
  for (int grey = 0; grey < 256; grey += 5) {
    Scene scene = scene_of(square(), material);
    scene.textures.push_back(texture_of(3, 3, std::vector<glm::u8vec4>(9, glm::u8vec4(grey, grey, grey, 255))));
    const glm::vec4 color = color_at(picture(scene, front_view(), with(Shading::flat)), 30, 35);
    ASSERT_EQ(srgb8_of_linear(color.r), grey);
  }
}

TEST(Shade, TexturesAreTheRightWayUp) {
  Material material;
  material.base_color_texture.texture = 0;
  Scene scene = scene_of(square(), material);
  scene.textures.push_back(
      texture_of(2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}}));
  scene.textures[0].nearest = true;
  const Image image = picture(scene, front_view(), with(Shading::flat));
  EXPECT_EQ(color_at(image, 20, 20), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(color_at(image, 43, 20), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(color_at(image, 20, 43), glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(color_at(image, 43, 43), glm::vec4(1, 1, 1, 1));
}

TEST(Shade, UvOfABigPerspectiveQuadFollowsTheGround) {
  // The ground y = -1 from behind the eye to far away; u = x, v = distance.
  Mesh mesh;
  mesh.positions = {{-100, -1, 1}, {100, -1, 1}, {100, -1, -400}, {-100, -1, -400}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texcoords.values = {{-100, -1}, {100, -1}, {100, 400}, {-100, 400}};
  View view;
  view.width = view.height = 100;
  view.projection = make_frustum(-1, 1, -1, 1, {1, 1000});
  const Image image = picture(scene_of(mesh), view, with(Shading::uv));
  for (const int y : {55, 60, 80, 99})
    for (const int x : {3, 50, 71}) {
      const double distance = 50 / (y + 0.5 - 50), u = (x + 0.5 - 50) / 50 * distance;
      const glm::vec4 color = color_at(image, x, y);
      EXPECT_NEAR(srgb_of_linear(double(color.r)), u - std::floor(u), 2e-3) << x << ", " << y;
      EXPECT_NEAR(srgb_of_linear(double(color.g)), distance - std::floor(distance), 2e-3) << x << ", " << y;
    }
}

TEST(Shade, ACheckerFarAwayIsGrey) {
  Material material;
  material.base_color_texture = {.texture = 0, .scale = {500, 500}};
  Scene scene = scene_of(square(), material);
  scene.textures.push_back(
      texture_of(2, 2, {{255, 255, 255, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}}));
  const Image image = picture(scene, front_view(), with(Shading::flat));
  EXPECT_NEAR(color_at(image, 25, 33).r, 0.5f, 0.01f);
}

TEST(Shade, NormalsAndTheirImage) {
  Scene scene = scene_of(square());
  // The square turned by 90 degrees about y looks along +x.
  scene.instances[0].world_from_mesh = glm::dmat4({0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1});
  View view = front_view();
  view.world_from_eye = look_at({10, 0, 0}, {0, 0, 0}, {0, 1, 0});
  const glm::vec4 color = color_at(picture(scene, view, with(Shading::normals)), 32, 32);
  EXPECT_EQ(srgb8_of_linear(color.r), 255);
  EXPECT_EQ(srgb8_of_linear(color.g), 128);
  EXPECT_EQ(srgb8_of_linear(color.b), 128);
  const Surfaces surfaces(scene);
  const Image normals = normal_image(surfaces, zbuffer(surfaces, view));
  const auto centre = std::size_t(32 * 64 + 32);
  EXPECT_EQ(normals.find("N.X")->floats()[centre], 1.0f);
  EXPECT_EQ(normals.find("N.Y")->floats()[centre], 0.0f);
  EXPECT_EQ(normals.find("N.X")->floats()[0], 0.0f);
  EXPECT_EQ(normals.find("A"), nullptr);
}

TEST(Shade, WithoutAMaterialColoursOfTheMeshAreNotDimmed) {
  Scene scene = scene_of(square());
  const glm::vec4 grey = color_at(picture(scene, front_view(), with(Shading::flat)), 32, 32);
  EXPECT_LT(grey.r, 0.7f) << "a mesh without colours shows its form on a white page";
  scene.meshes[0].colors.values.assign(4, glm::vec4(1, 0.5f, 0.25f, 1));
  EXPECT_EQ(color_at(picture(scene, front_view(), with(Shading::flat)), 32, 32), glm::vec4(1, 0.5f, 0.25f, 1));
  // The default material equals this one except for the base colour.
  Material white = colored(glm::vec4(1));
  white.roughness = 0.5f;
  EXPECT_EQ(color_at(picture(scene, front_view()), 32, 32),
            color_at(picture(scene_of(scene.meshes[0], white), front_view()), 32, 32));
  // With two meshes, only the one with vertex colours keeps them.
  scene.meshes.push_back(square());
  scene.instances.push_back({"beside", 1, glm::dmat4(1)});
  scene.instances[0].world_from_mesh[3] = {-1, 0, 0, 1};
  scene.instances[1].world_from_mesh[3] = {1, 0, -1, 1};
  const Image both = picture(scene, front_view(), with(Shading::flat));
  EXPECT_EQ(color_at(both, 16, 32), glm::vec4(1, 0.5f, 0.25f, 1));
  EXPECT_EQ(color_at(both, 56, 32), grey);
}

TEST(Shade, ColoursOfEveryFormatAreShownAsTheyAre) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string red = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string list = "property list uchar int vertex_indices\n";
  const std::string files[] = {
      ply + red + "element face 1\n" + list +
          "end_header\n-1 -1 0 255 0 0\n1 -1 0 255 0 0\n1 1 0 255 0 0\n-1 1 0 255 0 0\n4 0 1 2 3\n",
      ply + "element face 1\n" + list + red + "end_header\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3 255 0 0\n",
      "v -1 -1 0 1 0 0\nv 1 -1 0 1 0 0\nv 1 1 0 1 0 0\nv -1 1 0 1 0 0\nf 1 2 3 4\n",
      "COFF\n4 1 0\n-1 -1 0 255 0 0 255\n1 -1 0 255 0 0 255\n1 1 0 255 0 0 255\n-1 1 0 255 0 0 255\n4 0 1 2 3\n",
      "OFF\n4 1 0\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3 255 0 0\n"};
  for (const std::string& file : files) {
    LoadOptions options;
    if (file[0] == 'v') options.format = ModelFormat::obj;
    const Scene scene = load(std::as_bytes(std::span(file)), "red", options);
    EXPECT_EQ(color_at(picture(scene, front_view(), with(Shading::flat)), 32, 32), glm::vec4(1, 0, 0, 1)) << file;
  }
}

TEST(Shade, BothSidesOfASurfaceAreLitAlikeAndMirroringDoesNotTurnNormals) {
  Scene scene = scene_of(square());
  scene.meshes[0].normals.values.assign(4, glm::vec3(0, 0, 3));
  const glm::vec4 front = color_at(picture(scene, front_view()), 32, 32);
  scene.instances[0].world_from_mesh[2] = {0, 0, -1, 0};  // mirrored in depth
  EXPECT_EQ(color_at(picture(scene, front_view()), 32, 32), front);
  scene.instances[0].world_from_mesh = glm::dmat4(1);
  scene.instances[0].world_from_mesh[0] = {-1, 0, 0, 0};  // mirrored sideways
  EXPECT_EQ(color_at(picture(scene, front_view()), 32, 32), front);
  scene.instances[0].world_from_mesh[2] = {0, 0, -1, 0};  // a half turn: the back is visible
  EXPECT_EQ(color_at(picture(scene, front_view()), 32, 32), front);
}

TEST(Shade, NormalsFollowAStretchedInstance) {
  Scene scene = scene_of(square());
  scene.meshes[0].normals.values.assign(4, glm::normalize(glm::vec3(1, 0, 1)));
  scene.instances[0].world_from_mesh[0] = {2, 0, 0, 0};  // twice as wide: the normal leans half as far
  const Surfaces surfaces(scene);
  const Image normals = normal_image(surfaces, zbuffer(surfaces, front_view()));
  const auto centre = std::size_t(32 * 64 + 32);
  const float ratio = normals.find("N.X")->floats()[centre] / normals.find("N.Z")->floats()[centre];
  EXPECT_NEAR(ratio, 0.5f, 1e-6f);
}

TEST(Shade, NormalMapsLeanAlongUAndAgainstV) {
  Material material;
  material.normal_texture.texture = 0;
  const auto normal_with = [&](const glm::u8vec4& texel, float scale) {
    Scene scene = scene_of(square(), material);
    scene.materials[0].normal_scale = scale;
    scene.textures.push_back(texture_of(1, 1, {texel}));
    const Surfaces surfaces(scene);
    const Image normals = normal_image(surfaces, zbuffer(surfaces, front_view()));
    const auto centre = std::size_t(32 * 64 + 32);
    return glm::vec3(normals.find("N.X")->floats()[centre], normals.find("N.Y")->floats()[centre],
                     normals.find("N.Z")->floats()[centre]);
  };
  EXPECT_LT(glm::length(normal_with({128, 128, 255, 255}, 1) - glm::vec3(0, 0, 1)), 0.01f);
  EXPECT_LT(glm::length(normal_with({218, 128, 218, 255}, 1) - glm::normalize(glm::vec3(1, 0, 1))), 0.01f);
  EXPECT_LT(glm::length(normal_with({128, 218, 218, 255}, 1) - glm::normalize(glm::vec3(0, 1, 1))), 0.01f);
  EXPECT_LT(glm::length(normal_with({128, 218, 218, 255}, 0) - glm::vec3(0, 0, 1)), 0.01f);
}

TEST(Shade, DepthGoesFromBrightToDark) {
  Scene scene = scene_of(square());
  scene.instances.push_back({"behind", 0, glm::dmat4(1)});
  scene.instances[1].world_from_mesh[3] = {1, 0, -5, 1};
  const Image image = picture(scene, front_view(), with(Shading::depth));
  EXPECT_EQ(srgb8_of_linear(color_at(image, 20, 32).r), 242);  // 0.95
  EXPECT_EQ(srgb8_of_linear(color_at(image, 60, 32).r), 26);   // 0.10
}

TEST(Shade, EveryObjectHasAColourOfItsOwn) {
  Scene scene = scene_of(square());
  for (int i = 1; i < 12; ++i) scene.instances.push_back({"more", 0, glm::dmat4(1)});
  for (int i = 0; i < 12; ++i) {
    scene.instances[std::size_t(i)].world_from_mesh = glm::dmat4(0.1);
    scene.instances[std::size_t(i)].world_from_mesh[3] = {-1.8 + 0.3 * i, 0, 0, 1};
  }
  const Image image = picture(scene, front_view(128), with(Shading::ids));
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 12; ++i) colors.push_back(color_at(image, int(64 + 32 * (-1.8 + 0.3 * i)), 64));
  for (std::size_t a = 0; a < 12; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT(glm::length(colors[a] - colors[b]), 0.05f) << a << " " << b;
}

TEST(Shade, UnlitEmissiveAndVertexColours) {
  Material unlit = colored({0.25f, 0.5f, 0.75f, 1});
  unlit.unlit = true;
  EXPECT_EQ(color_at(picture(scene_of(square(), unlit), front_view()), 32, 32), glm::vec4(0.25f, 0.5f, 0.75f, 1));
  Material dark = colored({0, 0, 0, 1});
  dark.roughness = 1;
  const float without = color_at(picture(scene_of(square(), dark), front_view()), 32, 32).r;
  dark.emissive = {0.5f, 0, 0};
  EXPECT_NEAR(color_at(picture(scene_of(square(), dark), front_view()), 32, 32).r, without + 0.5f, 1e-6f);
  Mesh painted = square();
  painted.colors.values.assign(4, glm::vec4(0.5f, 1, 0, 1));
  const Material material = colored({1, 0.5f, 1, 1});
  EXPECT_EQ(color_at(picture(scene_of(painted, material), front_view(), with(Shading::flat)), 32, 32),
            glm::vec4(0.5f, 0.5f, 0, 1));
}

TEST(Shade, AWhiteMattSurfaceThatFacesTheLightIsJustBelowOne) {
  Material white;
  white.roughness = 1;
  Scene scene = scene_of(square(), white);
  float brightest = 0;
  for (int step = -8; step <= 8; step += tries_little ? 4 : 1)
    for (int tilt = -8; tilt <= 8; tilt += tries_little ? 4 : 1) {
      const glm::dmat4 pose = look_at({0.2 * step, 0.2 * tilt, 1}, {0, 0, 0}, {0, 1, 0});
      scene.instances[0].world_from_mesh = glm::dmat4(glm::dmat3(pose));
      brightest = std::max(brightest, color_at(picture(scene, front_view(16)), 8, 8).g);
    }
  EXPECT_GT(brightest, 0.85f);
  EXPECT_LT(brightest, 1.0f);
}

/// A small square floats in front of a large one, towards the key light: upper left and front.
Scene shadow_scene() {
  Scene scene = scene_of(square());
  scene.instances[0].world_from_mesh = glm::dmat4(2.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.instances.push_back({"before", 0, glm::dmat4(0.25)});
  scene.instances[1].world_from_mesh[3] = {-0.5, 0.5, 0.6, 1};
  return scene;
}

TEST(Shade, AShadowFallsToTheLowerRightAndNowhereElse) {
  const Image with_shadow = picture(shadow_scene(), front_view(128));
  const Image without = picture(shadow_scene(), front_view(128), {.light = {.shadows = Shadows::off}});
  const auto difference = [&](int x, int y) { return color_at(without, x, y).g - color_at(with_shadow, x, y).g; };
  // The light stands at (-0.50, 0.78, 0.62): at height 0.6 the shadow moves by (0.48, -0.75).
  EXPECT_GT(difference(64, 72), 0.1f);
  for (const glm::ivec2 lit : {glm::ivec2(64, 110), {20, 100}, {100, 30}, {110, 110}, {48, 48}, {20, 20}, {64, 40}})
    EXPECT_NEAR(difference(lit.x, lit.y), 0.0f, 1e-5f) << lit.x << ", " << lit.y;
}

TEST(Shade, SmoothAndSlantedSurfacesDoNotShadowThemselves) {
  Scene tilted = scene_of(square());
  for (const double angle : {0.2, 0.7, 1.2, 1.4}) {
    tilted.instances[0].world_from_mesh = glm::dmat4({std::cos(angle), 0, std::sin(angle), 0}, {0, 1, 0, 0},
                                                     {-std::sin(angle), 0, std::cos(angle), 0}, {0, 0, 0, 1});
    const Image lit = picture(tilted, front_view(), {.light = {.shadows = Shadows::off}}),
                shadowed = picture(tilted, front_view());
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        ASSERT_LT(glm::length(color_at(lit, x, y) - color_at(shadowed, x, y)), 1e-5f)
            << angle << ": " << x << ", " << y;
  }
}

View four_samples(const Surfaces& surfaces) {
  FrameOptions options;
  options.samples = 4;
  return frame(surfaces, 333, 222, options);
}

TEST(Shade, SameBytesForAnyNumberOfThreads) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, four_samples(surfaces));
  for (const Shading shading :
       {Shading::lit, Shading::flat, Shading::normals, Shading::depth, Shading::ids, Shading::uv}) {
    const std::uint64_t one = content_hash(shade(surfaces, visible, with(shading), {.threads = 1}));
    for (const int threads : {2, 5})
      EXPECT_EQ(content_hash(shade(surfaces, visible, with(shading), {.threads = threads})), one) << int(shading);
  }
  EXPECT_EQ(content_hash(normal_image(surfaces, visible, {.threads = 1})),
            content_hash(normal_image(surfaces, visible, {.threads = 3})));
}

TEST(Shade, BadAttributesGiveColoursNotNan) {
  Material material;
  material.base_color_texture.texture = material.normal_texture.texture = 0;
  Mesh mesh = square();
  mesh.normals.values = {{0, 0, 0}, {kNan, 0, 1}, {1e38f, 1e38f, 1e38f}, {0, 0, -1}};
  mesh.texcoords.values = {{kNan, 0}, {1e30f, 1e30f}, {0.5f, 0.5f}, {0.5f, 0.5f}};
  mesh.colors.values = {{kNan, 1, 1, 1}, {-1, 2, 1, 1}, {1, 1, 1, kNan}, {1, 1, 1, 1}};
  Scene scene = scene_of(mesh, material);
  scene.textures.push_back(texture_of(1, 1, {{128, 128, 255, 255}}));
  scene.instances.push_back({"flattened", 0, glm::dmat4(1)});
  scene.instances[1].world_from_mesh[2] = {0, 0, 0, 0};
  scene.instances[1].world_from_mesh[3] = {1, 1, -1, 1};
  for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals, Shading::uv}) {
    const Image image = picture(scene, front_view(64, 4), with(shading));
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const glm::vec4 color = color_at(image, x, y);
        for (int k = 0; k < 4; ++k)
          ASSERT_TRUE(color[k] >= 0 && color[k] <= 1) << int(shading) << ": " << x << ", " << y;
      }
  }
}

TEST(Shade, HugeTrianglesAcrossTheEyePlaneAreLit) {
  Mesh mesh;
  mesh.positions = {{-1e5f, -1, 1e5f}, {1e5f, -1, 1e5f}, {0, -1, -1e6f}};
  mesh.triangles = {{0, 1, 2}};
  View view;
  view.width = view.height = 64;
  view.samples = 4;
  view.projection = make_frustum(-1, 1, -1, 1, {1, 1e5});
  const Image image = picture(scene_of(mesh), view);
  const float reference = color_at(image, 32, 60).g;
  EXPECT_GT(reference, 0.2f);
  for (int y = 36; y < 64; ++y) EXPECT_NEAR(color_at(image, 32, y).g, reference, 0.25f) << y;
}

TEST(Shade, MaskedTexelsAreHolesAndBlendedOnesLetTheBackgroundThrough) {
  Material material = colored({1, 0, 0, 0.4f});
  const auto alpha_with = [&](Material::Alpha alpha) {
    material.alpha = alpha;
    return color_at(
        picture(scene_of(square(), material), front_view(), {.shading = Shading::flat, .background = std::nullopt}), 32,
        32);
  };
  EXPECT_EQ(alpha_with(Material::Alpha::opaque), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(alpha_with(Material::Alpha::mask), glm::vec4(0));
  // Alpha is the share that is not let through: 1 - (1 - 0.4), in floats.
  EXPECT_EQ(alpha_with(Material::Alpha::blend), glm::vec4(0.4f, 0, 0, 1.0f - (1.0f - 0.4f)));
}

TEST(Shade, WhatStandsBehindSeeThroughSurfacesIsShown) {
  const ShadeOptions options{.shading = Shading::flat, .background = std::nullopt};
  const Scene blended = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.25f});
  for (const int samples : {1, 4}) {
    const Image image = picture(blended, front_view(64, samples), options);
    EXPECT_EQ(color_at(image, 32, 32), glm::vec4(0.25f, 0, 0.75f, 1)) << samples;
    EXPECT_EQ(color_at(image, 10, 32), glm::vec4(0, 0, 1, 1)) << samples;
    EXPECT_EQ(color_at(image, 2, 32), glm::vec4(0)) << samples;
  }
  const Image masked = picture(layered_scene(Material::Alpha::mask, {1, 0, 0, 0.25f}), front_view(64, 4), options);
  EXPECT_EQ(color_at(masked, 32, 32), glm::vec4(0, 0, 1, 1));
  const Image solid = picture(layered_scene(Material::Alpha::mask, {1, 0, 0, 0.75f}), front_view(64, 4), options);
  EXPECT_EQ(color_at(solid, 32, 32), glm::vec4(1, 0, 0, 1));
}

TEST(Shade, SeveralSeeThroughSurfacesShowInTheOrderOfDepth) {
  const ShadeOptions options{.shading = Shading::flat, .background = std::nullopt};
  for (const bool back_first : {false, true}) {
    Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.5f});
    scene.materials[1].alpha = Material::Alpha::blend;
    scene.materials[1].base_color.a = 0.5f;
    if (back_first) std::swap(scene.instances[0], scene.instances[1]);
    const Image image = picture(scene, front_view(64, 4), options);
    EXPECT_EQ(color_at(image, 32, 32), glm::vec4(0.5f, 0, 0.25f, 0.75f));
  }
}

TEST(Shade, OpacityShowsWhatOpaqueSurfacesHide) {
  const ShadeOptions options{.shading = Shading::flat, .background = std::nullopt, .opacity = 0.5f};
  const Image image = picture(layered_scene(Material::Alpha::opaque, {1, 0, 0, 1}), front_view(64, 4), options);
  EXPECT_EQ(color_at(image, 32, 32), glm::vec4(0.5f, 0, 0.25f, 0.75f));
}

TEST(Shade, EdgesOfSeeThroughSurfacesBlendSampleBySample) {
  Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.5f});
  scene.instances[0].world_from_mesh[3] = {0.5 / 16, 0, 0, 1};   // half of pixel 16 is glass, half only blue
  scene.instances[1].world_from_mesh[3] = {0.5 / 16, 0, -1, 1};  // half of pixel 8 is blue, half is background
  const Image image = picture(scene, front_view(64, 4), {.shading = Shading::flat, .background = std::nullopt});
  EXPECT_EQ(color_at(image, 16, 32), glm::vec4(0.25f, 0, 0.75f, 1));
  EXPECT_EQ(color_at(image, 8, 32), glm::vec4(0, 0, 0.5f, 0.5f));
}

TEST(Shade, MeshesOfMixedMaterialsAreTakenApart) {
  Material glass = colored({1, 0, 0, 0});
  glass.alpha = Material::Alpha::blend;
  Scene scene = scene_of(square(), glass);
  scene.materials.push_back(colored({0, 1, 0, 1}));
  // A second square a step behind, in the same mesh, with vertices of its own.
  Mesh& mesh = scene.meshes[0];
  for (int i = 0; i < 4; ++i) mesh.positions.push_back(mesh.positions[std::size_t(i)] - glm::vec3(0, 0, 1));
  mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  mesh.material_ids = {0, 0, 1, 1};
  mesh.texcoords.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(color_at(picture(scene, front_view(), with(Shading::flat)), 32, 32), glm::vec4(0, 1, 0, 1));
}

}  // namespace
}  // namespace frontmost
