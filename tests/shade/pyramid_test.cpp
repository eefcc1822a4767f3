// SPDX-License-Identifier: Apache-2.0
#include "shade/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/srgb.h"

namespace frontmost::shading {
namespace {

Texture constant(int width, int height, const glm::u8vec4& value) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.pixels.assign(std::size_t(width) * std::size_t(height), value);
  return texture;
}

/// Squares of one texel, black and white.
Texture checker(int size) {
  Texture texture = constant(size, size, glm::u8vec4(255));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if ((x + y) % 2) texture.pixels[std::size_t(y * size + x)] = {0, 0, 0, 255};
  return texture;
}

/// Red, green / blue, white: which corner is where.
Texture corners() {
  Texture texture = constant(2, 2, glm::u8vec4(255));
  texture.pixels = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}};
  return texture;
}

TEST(Pyramid, EveryGreyComesBackAsItsOwnByteAtEveryLevel) {
  for (int grey = 0; grey < 256; ++grey) {
    const Texture texture = constant(13, 8, glm::u8vec4(grey, grey, grey, 255));
    const Pyramid pyramid(texture, Encoding::srgb);
    for (const float footprint : {0.0f, 0.1f, 0.3f, 5.0f}) {
      const glm::vec4 color = pyramid.sample({{0.4f, 0.7f}, {footprint, 0}, {0, footprint / 5}});
      ASSERT_EQ(srgb8_of_linear(color.r), grey) << "footprint " << footprint;
      ASSERT_EQ(color.a, 1.0f);
    }
  }
}

TEST(Pyramid, TheFirstRowIsAtVZeroAndTheFirstColumnAtUZero) {
  const Texture texture = corners();
  const Pyramid pyramid(texture, Encoding::srgb);
  EXPECT_EQ(pyramid.sample({{0.25f, 0.25f}, {}, {}}), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(pyramid.sample({{0.75f, 0.25f}, {}, {}}), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(pyramid.sample({{0.25f, 0.75f}, {}, {}}), glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(pyramid.sample({{0.5f, 0.5f}, {}, {}}), glm::vec4(0.5f, 0.5f, 0.5f, 1));
}

TEST(Pyramid, WrapModesDoWhatTheirNamesSay) {
  Texture texture = corners();
  const glm::vec2 outside(1.25f, -0.25f);  // repeat: (0.25, 0.75); mirror: (0.75, 0.25); clamp: (1, 0)
  const auto sample = [&](Texture::Wrap wrap) {
    texture.wrap_u = texture.wrap_v = wrap;
    return Pyramid(texture, Encoding::srgb).sample({outside, {}, {}});
  };
  EXPECT_EQ(sample(Texture::Wrap::repeat), glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(sample(Texture::Wrap::mirror), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(sample(Texture::Wrap::clamp), glm::vec4(0, 1, 0, 1));
}

TEST(Pyramid, RepeatingTexturesFilterAcrossTheirSeam) {
  Texture texture = constant(4, 1, {0, 0, 0, 255});
  texture.pixels[0] = {255, 255, 255, 255};
  EXPECT_EQ(Pyramid(texture, Encoding::linear).sample({{0.0f, 0.5f}, {}, {}}).r, 0.5f);
  texture.wrap_u = Texture::Wrap::clamp;
  EXPECT_EQ(Pyramid(texture, Encoding::linear).sample({{0.0f, 0.5f}, {}, {}}).r, 1.0f);
}

TEST(Pyramid, ACheckerFarAwayIsHalfTheLightNotHalfTheByte) {
  const Texture texture = checker(64);
  const Pyramid colors(texture, Encoding::srgb), numbers(texture, Encoding::linear);
  const TextureFootprint far{{0.3f, 0.6f}, {0.5f, 0}, {0, 0.5f}};
  EXPECT_NEAR(colors.sample(far).r, 0.5f, 0.003f);  // sRGB byte 188
  EXPECT_EQ(srgb8_of_linear(colors.sample(far).r), 188);
  EXPECT_NEAR(numbers.sample(far).r, 0.5f, 0.003f);
}

TEST(Pyramid, ASlantedFootprintStaysSharpAcrossItsShortSide) {
  // Stripes along v: a footprint that is long in v only must still tell them apart.
  Texture texture = constant(64, 64, {0, 0, 0, 255});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; x += 2) texture.pixels[std::size_t(y * 64 + x)] = {255, 255, 255, 255};
  const Pyramid pyramid(texture, Encoding::linear);
  const TextureFootprint slanted{{10.5f / 64, 0.5f}, {1.0f / 64, 0}, {0, 7.0f / 64}};
  EXPECT_GT(pyramid.sample(slanted).r, 0.95f);
  const TextureFootprint wide{{10.5f / 64, 0.5f}, {7.0f / 64, 0}, {0, 7.0f / 64}};
  EXPECT_NEAR(pyramid.sample(wide).r, 0.5f, 0.05f);
}

TEST(Pyramid, OddSizesWeighEveryTexelAlike) {
  for (const int size : {3, 5, 7, 21}) {
    Texture texture = constant(size, size, {0, 0, 0, 255});
    double sum = 0;
    for (std::size_t i = 0; i < texture.pixels.size(); ++i) {
      texture.pixels[i].r = std::uint8_t(i * 37 % 256);
      sum += texture.pixels[i].r;
    }
    const Pyramid pyramid(texture, Encoding::linear);
    EXPECT_NEAR(pyramid.average().r * 255, sum / double(texture.pixels.size()), 2.5) << size;
  }
}

TEST(Pyramid, WhatATransparentTexelHidesDoesNotBleed) {
  Texture texture = constant(2, 1, {255, 0, 0, 255});
  texture.pixels[1] = {0, 255, 0, 0};
  const glm::vec4 mean = Pyramid(texture, Encoding::srgb).average();
  EXPECT_EQ(glm::vec3(mean), glm::vec3(1, 0, 0));
  EXPECT_NEAR(mean.a, 0.5f, 0.003f);
}

TEST(Pyramid, NearestTexturesAreNotFiltered) {
  Texture texture = corners();
  texture.nearest = true;
  const Pyramid pyramid(texture, Encoding::srgb);
  EXPECT_EQ(pyramid.level_count(), 1);
  EXPECT_EQ(pyramid.sample({{0.49f, 0.49f}, {3, 0}, {0, 3}}), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(pyramid.sample({{0.51f, 0.49f}, {3, 0}, {0, 3}}), glm::vec4(0, 1, 0, 1));
}

TEST(Pyramid, NoCoordinateLeadsOutOfTheTexture) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto wrap : {Texture::Wrap::repeat, Texture::Wrap::mirror, Texture::Wrap::clamp})
    for (const bool nearest : {false, true}) {
      Texture texture = checker(5);
      texture.wrap_u = texture.wrap_v = wrap;
      texture.nearest = nearest;
      const Pyramid pyramid(texture, Encoding::srgb);
      for (const float t : {nan, inf, -inf, 1e30f, -1e30f, 999999.0f, -0.0f, 1.0f, -1e-9f, 0.99999994f})
        for (const float d : {0.0f, 1e-30f, 1.0f, 1e20f, inf, nan}) {
          const glm::vec4 color = pyramid.sample({{t, -t}, {d, 0}, {0, d}});
          for (int k = 0; k < 4; ++k) ASSERT_TRUE(color[k] >= 0 && color[k] <= 1.001f) << t << " " << d;
        }
    }
  EXPECT_EQ(Pyramid(Texture{}, Encoding::srgb).sample({{0.5f, 0.5f}, {1, 0}, {0, 1}}), glm::vec4(1));
}

TEST(Pyramid, LogarithmIsContinuousAndNearlyRight) {
  for (float x = 0.001f; x < 1e5f; x *= 1.01f) ASSERT_NEAR(approximate_log2(x), std::log2(x), 0.01f) << x;
  EXPECT_EQ(approximate_log2(8.0f), 3.0f);
  EXPECT_NEAR(approximate_log2(std::nextafter(8.0f, 0.0f)), 3.0f, 1e-5f);
}

TEST(TexcoordTransform, FollowsTheTextureTransformExtension) {
  TextureUse use;
  use.offset = {0.5f, 0.25f};
  use.scale = {2, 3};
  const TextureFootprint moved = transformed(TexcoordTransform(use), {{0.1f, 0.2f}, {1, 0}, {0, 1}});
  EXPECT_NEAR(moved.texcoord.x, 0.7f, 1e-6f);
  EXPECT_NEAR(moved.texcoord.y, 0.85f, 1e-6f);
  EXPECT_EQ(moved.dx, glm::vec2(2, 0));
  EXPECT_EQ(moved.dy, glm::vec2(0, 3));
  // A quarter turn counter-clockwise, v down: u leads to -v.
  TextureUse turned;
  turned.rotation = 1.57079632679f;
  const glm::vec2 uv = TexcoordTransform(turned).place({1, 0});
  EXPECT_NEAR(uv.x, 0.0f, 1e-6f);
  EXPECT_NEAR(uv.y, -1.0f, 1e-6f);
}

}  // namespace
}  // namespace frontmost::shading
