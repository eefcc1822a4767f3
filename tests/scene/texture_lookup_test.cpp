// SPDX-License-Identifier: Apache-2.0
// Lookup by texture coordinates: wrapping, neighbours and rotation, with known answers and hostile numbers.
#include "scene/texture_lookup.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using Wrap = Texture::Wrap;
constexpr Wrap all_wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

TEST(TextureLookup, WrapsAsTheFormatsSay) {
  const struct {
    float t, repeat, clamp, mirror;
  } known[] = {{0.25f, 0.25f, 0.25f, 0.25f},
               {1.25f, 0.25f, 1, 0.75f},
               {-0.25f, 0.75f, 0, 0.25f},
               {2.5f, 0.5f, 1, 0.5f},
               {-1.75f, 0.25f, 0, 0.25f},
               {3, 0, 1, 1},
               {0, 0, 0, 0},
               {1, 0, 1, 1},
               {-2, 0, 0, 0}};
  for (const auto& k : known) {
    EXPECT_EQ(wrapped(k.t, Wrap::repeat), k.repeat) << k.t;
    EXPECT_EQ(wrapped(k.t, Wrap::clamp), k.clamp) << k.t;
    EXPECT_EQ(wrapped(k.t, Wrap::mirror), k.mirror) << k.t;
  }
}

TEST(TextureLookup, AbsurdCoordinatesAreTheCorner) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float t : {1e6f, -1e6f, 3e38f, infinity, -infinity, std::nanf("")})
    for (const Wrap wrap : all_wraps) EXPECT_EQ(wrapped(t, wrap), 0.0f) << t;
  for (const Wrap wrap : all_wraps) EXPECT_GT(wrapped(999999.5f, wrap), 0.0f) << "large, but not absurd";
}

// Any coordinate leads to a texel inside the texture, as no later code checks again.
TEST(TextureLookup, TexelsAreAlwaysThere) {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const int exponent = random.below(60) - 30;
    const float t = std::ldexp(random.within(-1, 1), exponent);
    const int size = 1 + random.below(i % 2 ? 4 : 16384);
    for (const Wrap wrap : all_wraps) {
      const TexelPair pair = texel_pair(t, size, wrap);
      ASSERT_TRUE(pair.first >= 0 && pair.first < size) << t;
      ASSERT_TRUE(pair.second >= 0 && pair.second < size) << t;
      ASSERT_TRUE(pair.fraction >= 0 && pair.fraction <= 1) << t;
      const int texel = texel_of(t, size, wrap);
      ASSERT_TRUE(texel >= 0 && texel < size) << t;
      ASSERT_TRUE(texel == pair.first || texel == pair.second) << t << ": the nearest is one of the two";
    }
  }
}

TEST(TextureLookup, NeighboursOfTheEnds) {
  // At the very start of four texels, half of the weight belongs to the texel before.
  const TexelPair repeated = texel_pair(0.0f, 4, Wrap::repeat);
  EXPECT_EQ(repeated.first, 3);
  EXPECT_EQ(repeated.second, 0);
  EXPECT_EQ(repeated.fraction, 0.5f);
  for (const Wrap wrap : {Wrap::clamp, Wrap::mirror}) {
    const TexelPair start = texel_pair(0.0f, 4, wrap), end = texel_pair(1.0f, 4, wrap);
    EXPECT_EQ(start.first, 0);
    EXPECT_EQ(start.second, 0);
    EXPECT_EQ(end.first, 3);
    EXPECT_EQ(end.second, 3);
  }
  // In the middle of a texel only that texel counts.
  for (const Wrap wrap : all_wraps) {
    const TexelPair middle = texel_pair(0.375f, 4, wrap);
    EXPECT_EQ(middle.first, 1);
    EXPECT_EQ(middle.fraction, 0.0f);
    EXPECT_EQ(texel_of(0.375f, 4, wrap), 1);
  }
  EXPECT_EQ(texel_of(1.0f, 4, Wrap::clamp), 3) << "the end belongs to the last one";
}

TEST(TextureLookup, RepeatsAndMirrorsByPeriods) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const float t = float(random.below(4096)) / 1024 - 2;  // whole steps: sums are exact
    ASSERT_EQ(wrapped(t + 1, Wrap::repeat), wrapped(t, Wrap::repeat));
    ASSERT_EQ(wrapped(t + 2, Wrap::mirror), wrapped(t, Wrap::mirror));
    ASSERT_EQ(wrapped(-t, Wrap::mirror), wrapped(t, Wrap::mirror));
  }
}

// KHR_texture_transform: translation * rotation * scale, where the rotation is counter-clockwise in a space with v
// down.
TEST(TexcoordTransform, IsThatOfTheExtension) {
  EXPECT_EQ(TexcoordTransform(TextureUse{}).place({0.25f, 0.75f}), glm::vec2(0.25f, 0.75f));
  TextureUse use;
  use.offset = {10, 20};
  use.scale = {2, 4};
  EXPECT_EQ(TexcoordTransform(use).place({0.5f, 0.25f}), glm::vec2(11, 21));
  EXPECT_EQ(TexcoordTransform(use).step({0.5f, 0.25f}), glm::vec2(1, 1)) << "a step has no offset";
  use.offset = {0, 0};
  use.scale = {1, 1};
  use.rotation = 1.57079632679f;
  // The extension's matrix is (cos, sin; -sin, cos): u = 1 leads to (0, -1), v = 1 to (1, 0).
  const glm::vec2 across = TexcoordTransform(use).place({1, 0}), down = TexcoordTransform(use).place({0, 1});
  EXPECT_NEAR(across.x, 0, 1e-6);
  EXPECT_NEAR(across.y, -1, 1e-6);
  EXPECT_NEAR(down.x, 1, 1e-6);
  EXPECT_NEAR(down.y, 0, 1e-6);
  // The scale acts first, the rotation second.
  use.scale = {3, 1};
  EXPECT_NEAR(TexcoordTransform(use).place({1, 0}).y, -3, 1e-6);
}

TEST(FloorOf, IsTheFloorOfNegativesToo) {
  const struct {
    float value;
    int floor;
  } known[] = {{0, 0}, {-0.0f, 0}, {0.99f, 0}, {1, 1}, {-0.01f, -1}, {-1, -1}, {-1.5f, -2}, {12345.75f, 12345}};
  for (const auto& k : known) EXPECT_EQ(floor_of(k.value), k.floor) << k.value;
}

}  // namespace
}  // namespace frontmost::test
