// SPDX-License-Identifier: Apache-2.0
// Textures with mip levels, and the values of lookups: against a reference for one fragment at a time, in doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "base/srgb.h"
#include "shade/texture/texture_sampler.h"
#include "support/random_scene.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

using test::Random;

/// Position of a lookup, and its change from pixel to pixel, in texture coordinates.
struct Footprint {
  glm::vec2 texcoord{0}, dx{0}, dy{0};
};

/// Looks up all footprints in one batch, at most sampled_at_once of them.
std::vector<glm::vec4> samples(const Pyramid& pyramid, const std::vector<Footprint>& footprints,
                               const TexcoordTransform& transform = TexcoordTransform(TextureUse{}),
                               Isa isa = Isa::best) {
  const auto texcoord = std::make_unique<TexcoordLanes>();
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    texcoord->value.set(int(i), footprints[i].texcoord);
    texcoord->dx.set(int(i), footprints[i].dx);
    texcoord->dy.set(int(i), footprints[i].dy);
  }
  std::vector<glm::vec4> values(footprints.size());
  TextureSampler sampler(isa);
  sampler.begin(*texcoord, 0, int(footprints.size()));
  sampler.sample(pyramid, transform, values.data());
  return values;
}

glm::vec4 sample(const Pyramid& pyramid, const Footprint& footprint) { return samples(pyramid, {footprint})[0]; }
/// Looked up from so far away that the whole texture is one texel.
glm::vec4 average(const Pyramid& pyramid) { return sample(pyramid, {{0.5f, 0.5f}, {1e6f, 0}, {0, 1e6f}}); }

Texture constant(int width, int height, const glm::u8vec4& value) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.pixels.assign(std::size_t(width) * std::size_t(height), value);
  return texture;
}

/// Squares of one texel, alternately black and white.
Texture checker(int size) {
  Texture texture = constant(size, size, glm::u8vec4(255));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if ((x + y) % 2) texture.pixels[std::size_t(y * size + x)] = {0, 0, 0, 255};
  return texture;
}

/// A texture with red, green / blue, white, to tell its corners apart.
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
      const glm::vec4 color = sample(pyramid, {{0.4f, 0.7f}, {footprint, 0}, {0, footprint / 5}});
      ASSERT_EQ(srgb8_of_linear(color.r), grey) << "footprint " << footprint;
      ASSERT_EQ(color.a, 1.0f);
    }
  }
}

TEST(Pyramid, TheFirstRowIsAtVZeroAndTheFirstColumnAtUZero) {
  const Texture texture = corners();
  const Pyramid pyramid(texture, Encoding::srgb);
  EXPECT_EQ(sample(pyramid, {{0.25f, 0.25f}, {}, {}}), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(sample(pyramid, {{0.75f, 0.25f}, {}, {}}), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(sample(pyramid, {{0.25f, 0.75f}, {}, {}}), glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(sample(pyramid, {{0.5f, 0.5f}, {}, {}}), glm::vec4(0.5f, 0.5f, 0.5f, 1));
}

TEST(Pyramid, WrapModesDoWhatTheirNamesSay) {
  Texture texture = corners();
  const glm::vec2 outside(1.25f, -0.25f);  // repeat: (0.25, 0.75); mirror: (0.75, 0.25); clamp: (1, 0)
  const auto sample = [&](Texture::Wrap wrap) {
    texture.wrap_u = texture.wrap_v = wrap;
    return shading::sample(Pyramid(texture, Encoding::srgb), {outside, {}, {}});
  };
  EXPECT_EQ(sample(Texture::Wrap::repeat), glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(sample(Texture::Wrap::mirror), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(sample(Texture::Wrap::clamp), glm::vec4(0, 1, 0, 1));
}

TEST(Pyramid, RepeatingTexturesFilterAcrossTheirSeam) {
  Texture texture = constant(4, 1, {0, 0, 0, 255});
  texture.pixels[0] = {255, 255, 255, 255};
  EXPECT_EQ(sample(Pyramid(texture, Encoding::linear), {{0.0f, 0.5f}, {}, {}}).r, 0.5f);
  texture.wrap_u = Texture::Wrap::clamp;
  EXPECT_EQ(sample(Pyramid(texture, Encoding::linear), {{0.0f, 0.5f}, {}, {}}).r, 1.0f);
}

TEST(Pyramid, ACheckerFarAwayIsHalfTheLightNotHalfTheByte) {
  const Texture texture = checker(64);
  const Pyramid colors(texture, Encoding::srgb), numbers(texture, Encoding::linear);
  const Footprint far{{0.3f, 0.6f}, {0.5f, 0}, {0, 0.5f}};
  EXPECT_NEAR(sample(colors, far).r, 0.5f, 0.003f);  // sRGB byte 188
  EXPECT_EQ(srgb8_of_linear(sample(colors, far).r), 188);
  EXPECT_NEAR(sample(numbers, far).r, 0.5f, 0.003f);
}

/// Mean of four opaque texels in one channel, by the definition.
std::uint8_t mean_of(const std::array<std::uint8_t, 4>& bytes, Encoding encoding) {
  if (encoding == Encoding::linear) return std::uint8_t((bytes[0] + bytes[1] + bytes[2] + bytes[3] + 2) / 4);
  return srgb8_of_linear(0.25f * ((linear_of_srgb8(bytes[0]) + linear_of_srgb8(bytes[1])) +
                                  (linear_of_srgb8(bytes[2]) + linear_of_srgb8(bytes[3]))));
}

TEST(Pyramid, FourOpaqueTexelsMakeTheirMeanWhateverIsBesideThem) {
  std::mt19937 random(test::noted_seed(11));
  for (const Encoding encoding : {Encoding::srgb, Encoding::linear})
    for (const bool has_clear : {false, true}) {
      Texture texture = constant(38, 22, glm::u8vec4(255));
      for (glm::u8vec4& texel : texture.pixels) {
        for (int k = 0; k < 3; ++k) texel[k] = std::uint8_t(random());
        if (has_clear && random() % 50 == 0) texel.a = std::uint8_t(random());
      }
      const Pyramid pyramid(texture, encoding);
      int found = 0;
      for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 19; ++x) {
          const glm::u8vec4* const upper = texture.pixels.data() + 2 * y * 38 + 2 * x;
          const std::array<glm::u8vec4, 4> four{upper[0], upper[1], upper[38], upper[39]};
          if ((four[0].a & four[1].a & four[2].a & four[3].a) != 255) continue;
          ++found;
          const glm::u8vec4& mean = pyramid.levels()[1].texels[y * 19 + x];
          ASSERT_EQ(mean.a, 255);
          for (int k = 0; k < 3; ++k)
            ASSERT_EQ(mean[k], mean_of({four[0][k], four[1][k], four[2][k], four[3][k]}, encoding)) << x << ", " << y;
        }
      EXPECT_EQ(found == 11 * 19, !has_clear);
    }
}

TEST(Pyramid, ASlantedFootprintStaysSharpAcrossItsShortSide) {
  // Stripes along v: a footprint that is long only in v must still tell them apart.
  Texture texture = constant(64, 64, {0, 0, 0, 255});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; x += 2) texture.pixels[std::size_t(y * 64 + x)] = {255, 255, 255, 255};
  const Pyramid pyramid(texture, Encoding::linear);
  const Footprint slanted{{10.5f / 64, 0.5f}, {1.0f / 64, 0}, {0, 7.0f / 64}};
  EXPECT_GT(sample(pyramid, slanted).r, 0.95f);
  const Footprint wide{{10.5f / 64, 0.5f}, {7.0f / 64, 0}, {0, 7.0f / 64}};
  EXPECT_NEAR(sample(pyramid, wide).r, 0.5f, 0.05f);
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
    EXPECT_NEAR(average(pyramid).r * 255, sum / double(texture.pixels.size()), 2.5) << size;
  }
}

TEST(Pyramid, WhatATransparentTexelHidesDoesNotBleed) {
  Texture texture = constant(2, 1, {255, 0, 0, 255});
  texture.pixels[1] = {0, 255, 0, 0};
  const glm::vec4 mean = average(Pyramid(texture, Encoding::srgb));
  EXPECT_EQ(glm::vec3(mean), glm::vec3(1, 0, 0));
  EXPECT_NEAR(mean.a, 0.5f, 0.003f);
}

TEST(Pyramid, NearestTexturesAreNotFiltered) {
  Texture texture = corners();
  texture.nearest = true;
  const Pyramid pyramid(texture, Encoding::srgb);
  EXPECT_EQ(int(pyramid.levels().size()), 1);
  EXPECT_EQ(sample(pyramid, {{0.49f, 0.49f}, {3, 0}, {0, 3}}), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(sample(pyramid, {{0.51f, 0.49f}, {3, 0}, {0, 3}}), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(sample(pyramid, {{0.49f, 0.49f}, {3, 0}, {0, 0.1f}}), glm::vec4(1, 0, 0, 1)) << "however slanted";
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
          const glm::vec4 color = sample(pyramid, {{t, -t}, {d, 0}, {0, d}});
          for (int k = 0; k < 4; ++k) ASSERT_TRUE(color[k] >= 0 && color[k] <= 1.001f) << t << " " << d;
        }
    }
  EXPECT_EQ(sample(Pyramid(Texture{}, Encoding::srgb), {{0.5f, 0.5f}, {1, 0}, {0, 1}}), glm::vec4(1));
}

/// The reference: one fragment at a time, in doubles.
class Reference {
 public:
  explicit Reference(const Pyramid& pyramid) : pyramid_(pyramid) {}

  [[nodiscard]] glm::dvec4 sample(const Footprint& f) const {
    const auto& levels = pyramid_.levels();
    const glm::dvec2 size(levels[0].width, levels[0].height);
    const double along_x = glm::length(glm::dvec2(f.dx) * size), along_y = glm::length(glm::dvec2(f.dy) * size);
    const double longer = std::max(along_x, along_y), shorter = std::max(std::min(along_x, along_y), 1.0);
    if (longer <= 1) return bilinear(0, f.texcoord);
    const int count = std::min(most_taps, int(longer / shorter + 0.999f));
    const double last = double(levels.size() - 1);
    const double level = std::min(near_log2(std::max(shorter, longer / most_taps)), last);
    const glm::dvec2 axis = along_x > along_y ? f.dx : f.dy;
    glm::dvec4 sum(0);
    for (int i = 0; i < count; ++i)
      sum += trilinear(glm::dvec2(f.texcoord) + axis * ((i + 0.5) / count - 0.5), std::max(level, 0.0));
    return sum / double(count);
  }

 private:
  /// Parabolas through the exact values at powers of two, at most 0.01 off.
  static double near_log2(double value) {
    int exponent = 0;
    const double t = 2 * std::frexp(value, &exponent) - 1;
    return exponent - 1 + t * (1.3465 - 0.3465 * t);
  }
  [[nodiscard]] double light(std::uint8_t byte) const {
    return pyramid_.encoding() == Encoding::srgb ? double(linear_of_srgb8(byte)) : byte / 255.0;
  }
  [[nodiscard]] glm::dvec4 texel(const Pyramid::Level& level, int x, int y) const {
    const glm::u8vec4 t = level.texels[y * level.width + x];
    return {light(t.r), light(t.g), light(t.b), t.a / 255.0};
  }
  [[nodiscard]] glm::dvec4 bilinear(int number, const glm::dvec2& at) const {
    const Pyramid::Level& level = pyramid_.levels()[std::size_t(number)];
    const TexelPair x = texel_pair(float(at.x), level.width, pyramid_.texture().wrap_u);
    const TexelPair y = texel_pair(float(at.y), level.height, pyramid_.texture().wrap_v);
    const auto row = [&](int v) {
      return glm::mix(texel(level, x.first, v), texel(level, x.second, v), double(x.fraction));
    };
    return glm::mix(row(y.first), row(y.second), double(y.fraction));
  }
  [[nodiscard]] glm::dvec4 trilinear(const glm::dvec2& at, double level) const {
    const int finer = int(level);
    if (level == finer) return bilinear(finer, at);
    return glm::mix(bilinear(finer, at), bilinear(finer + 1, at), level - finer);
  }

  const Pyramid& pyramid_;
};

Texture random_texture(Random& random) {
  Texture texture = constant(1 + random.below(40), 1 + random.below(40), {});
  const int smoothness = 1 + random.below(60);
  for (glm::u8vec4& t : texture.pixels)
    for (int k = 0; k < 4; ++k) t[k] = std::uint8_t(128 + random.below(2 * smoothness) - smoothness);
  texture.wrap_u = Texture::Wrap(random.below(3));
  texture.wrap_v = Texture::Wrap(random.below(3));
  return texture;
}

std::vector<Footprint> random_footprints(Random& random) {
  std::vector<Footprint> footprints;
  const auto vector = [&](double size) {
    return glm::vec2(glm::dvec2(random.unit() - 0.5, random.unit() - 0.5) * size);
  };
  for (int i = 0; i < sampled_at_once - random.below(20); ++i) {
    const double reach = std::exp2(-10 + 12 * random.unit());
    footprints.push_back({vector(6), vector(reach), vector(reach * std::exp2(-4 * random.unit()))});
  }
  return footprints;
}

TEST(TextureSampler, IsWithinAThirdOfAStepOfOneAtATimeInDoubles) {
  Random random(3);
  std::size_t compared = 0;
  for (int round = 0; round < 300; ++round) {
    const Texture texture = random_texture(random);
    const Pyramid pyramid(texture, Encoding(random.below(2)));
    const Reference reference(pyramid);
    const std::vector<Footprint> footprints = random_footprints(random);
    const std::vector<glm::vec4> found = samples(pyramid, footprints);
    for (std::size_t i = 0; i < footprints.size(); ++i) {
      const glm::dvec4 expected = reference.sample(footprints[i]);
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[i][k], expected[k], 0.33 / 255) << round << " " << i << " " << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 10'000u);
}

TEST(TextureSampler, GivesTheSameBytesOnEveryInstructionSet) {
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    Texture texture = random_texture(random);
    texture.nearest = round % 5 == 0;
    const Pyramid pyramid(texture, Encoding(random.below(2)));
    const std::vector<Footprint> footprints = random_footprints(random);
    TextureUse use;
    use.rotation = random.unit();
    use.offset = {0.25f, random.unit()};
    const std::vector<glm::vec4> expected = samples(pyramid, footprints, TexcoordTransform(use));
    for (const Isa isa : available_isas()) {
      const std::vector<glm::vec4> found = samples(pyramid, footprints, TexcoordTransform(use), isa);
      ASSERT_EQ(std::memcmp(expected.data(), found.data(), found.size() * sizeof(glm::vec4)), 0) << name(isa);
    }
  }
}

TEST(TextureSampler, TexturesOfOtherSizesAndWrapsAreNotLookedUpAtEachOthersPlaces) {
  const auto texcoord = std::make_unique<TexcoordLanes>();
  texcoord->value.set(0, {1.3f, -0.2f});
  std::vector<Texture> textures;
  for (const int size : {4, 7, 4, 4}) textures.push_back(checker(size));
  textures[2].wrap_u = Texture::Wrap::clamp;
  textures[3].nearest = true;
  TextureSampler together(Isa::best);
  together.begin(*texcoord, 0, 1);
  for (const Texture& texture : textures) {
    const Pyramid pyramid(texture, Encoding::linear);
    glm::vec4 value;
    together.sample(pyramid, TexcoordTransform(TextureUse{}), &value);
    EXPECT_EQ(value, sample(pyramid, {{1.3f, -0.2f}, {}, {}}));
  }
}

TEST(TextureSampler, ReadsNothingBehindTexturesLongerThanFloatsTellApart) {
  for (const Texture::Wrap wrap : {Texture::Wrap::clamp, Texture::Wrap::repeat}) {
    Texture texture = constant((1 << 23) + 1022, 1, glm::u8vec4(255));
    texture.wrap_u = texture.wrap_v = wrap;
    const Pyramid pyramid(texture, Encoding::linear);
    for (const float t : {0.0f, 1.0f, 0.99999994f, -1e-9f})
      EXPECT_EQ(sample(pyramid, {{t, t}, {}, {}}), glm::vec4(1)) << t;
  }
}

TEST(TextureSampler, EveryByteIsItsOwnLight) {
  for (int byte = 0; byte < 256; ++byte) {
    const glm::u8vec4 texel(byte, byte, byte, byte);
    const Texture texture = constant(1, 1, texel);
    const glm::vec4 color = sample(Pyramid(texture, Encoding::srgb), {{0.5f, 0.5f}, {}, {}});
    const double step = double(linear_of_srgb8(std::uint8_t(std::min(byte + 1, 255)))) -
                        double(linear_of_srgb8(std::uint8_t(std::max(byte - 1, 0))));
    EXPECT_NEAR(color.r, linear_of_srgb8(std::uint8_t(byte)), 0.01 * step) << byte;
    EXPECT_NEAR(color.a, byte / 255.0, 1e-7);
    EXPECT_EQ(sample(Pyramid(texture, Encoding::linear), {{0.5f, 0.5f}, {}, {}}).r, color.a);
  }
}

TEST(TexcoordTransform, FollowsTheTextureTransformExtension) {
  TextureUse use;
  use.offset = {0.5f, 0.25f};
  use.scale = {2, 3};
  const TexcoordTransform moved(use);
  EXPECT_NEAR(moved.place({0.1f, 0.2f}).x, 0.7f, 1e-6f);
  EXPECT_NEAR(moved.place({0.1f, 0.2f}).y, 0.85f, 1e-6f);
  EXPECT_EQ(moved.step({1, 0}), glm::vec2(2, 0));
  EXPECT_EQ(moved.step({0, 1}), glm::vec2(0, 3));
  // A quarter turn counter-clockwise with v down: u becomes -v.
  TextureUse turned;
  turned.rotation = 1.57079632679f;
  const glm::vec2 uv = TexcoordTransform(turned).place({1, 0});
  EXPECT_NEAR(uv.x, 0.0f, 1e-6f);
  EXPECT_NEAR(uv.y, -1.0f, 1e-6f);
}

}  // namespace
}  // namespace frontmost::shading
