// SPDX-License-Identifier: Apache-2.0
// Colours on their way to screens and files; and the error messages for invalid images.
#include "image/srgb_pixels.h"

#include <cmath>
#include <limits>

#include "support/refusal.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

TEST(ColorPlanes, NeedAllThreeColoursInFloats) {
  EXPECT_TRUE(color_planes(random_floats(2, 2, {"R", "G", "B"})).has_value());
  EXPECT_TRUE(color_planes(random_floats(2, 2, {"Z", "B", "A", "R", "G"})).has_value()) << "in any order";
  EXPECT_FALSE(color_planes(random_floats(2, 2, {"R", "G"})).has_value());
  EXPECT_FALSE(color_planes(random_floats(2, 2, {"r", "g", "b"})).has_value());
  EXPECT_FALSE(color_planes(random_ids(2, 2, {"R", "G", "B"})).has_value());
  Image mixed = random_floats(2, 2, {"R", "G", "B"});
  mixed.channels.push_back(id_channel("A", {1, 2, 3, 4}));
  ASSERT_TRUE(color_planes(mixed).has_value());
  EXPECT_EQ(color_planes(mixed)->alpha, nullptr) << "ids are no alpha";
  const Image swapped = random_floats(2, 2, {"B", "G", "R"});
  EXPECT_EQ(color_planes(swapped)->color[0], swapped.channels[2].floats().data());
}

TEST(ColorPlanes, AreOpaqueWhenEveryAlphaRoundsToOne) {
  const float infinity = std::numeric_limits<float>::infinity(), last = 254.5f / 255;
  // Places around the borders of the blocks in which alphas are examined.
  for (const std::size_t place : {std::size_t(0), std::size_t(4095), std::size_t(4096), std::size_t(9999)}) {
    Image image = random_floats(100, 100, {"R", "G", "B", "A"});
    Buffer<float>& alpha = image.channels[3].floats();
    for (float& value : alpha) value = 1;
    EXPECT_TRUE(color_planes(image)->is_opaque());
    for (const float odd : {2.0f, infinity, std::nextafter(last, 1.0f)}) {
      alpha[place] = odd;
      EXPECT_TRUE(color_planes(image)->is_opaque()) << odd;
    }
    for (const float odd : {last, 0.5f, 0.0f, -1.0f, -infinity, std::nanf("")}) {
      alpha[place] = odd;
      EXPECT_FALSE(color_planes(image)->is_opaque()) << odd << " at " << place;
    }
  }
}

TEST(RoundedFraction, IsTheNearestAndClamped) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (int value = 0; value < 256; ++value) EXPECT_EQ(rounded_fraction<std::uint8_t>(float(value) / 255), value);
  for (int value = 0; value < 65536; value += 17)
    EXPECT_EQ(rounded_fraction<std::uint16_t>(float(value) / 65535), value);
  EXPECT_EQ(rounded_fraction<std::uint8_t>(0.49f / 255), 0);
  EXPECT_EQ(rounded_fraction<std::uint8_t>(0.51f / 255), 1);
  for (const float low : {-1.0f, -0.0f, -infinity, std::nanf("")}) EXPECT_EQ(rounded_fraction<std::uint8_t>(low), 0);
  for (const float high : {1.0f, 1.5f, infinity}) EXPECT_EQ(rounded_fraction<std::uint16_t>(high), 65535);
}

TEST(StoreSrgb, DividesByAlpha) {
  std::uint8_t out[3];
  const float half[3] = {0.25f, 0.125f, 0};
  store_srgb(half, 0.5f, out);  // straight: 0.5, 0.25, 0
  EXPECT_EQ(out[0], 188);
  EXPECT_EQ(out[1], 137);
  EXPECT_EQ(out[2], 0);
  store_srgb(half, 1.0f, out);  // premultiplied
  EXPECT_EQ(out[0], 137);
  store_srgb(half, 2.0f, out);
  EXPECT_EQ(out[0], 137) << "more than opaque is opaque";
  for (const float none : {0.0f, -1.0f, std::nanf("")}) {
    store_srgb(half, none, out);
    EXPECT_EQ(int(out[0]) + out[1] + out[2], 0) << none;
  }
}

// Premultiplied and straight pictures of the same colours store the same bytes, but for rounding of the division.
TEST(SrgbRows, StraightColoursDoNotDependOnAlpha) {
  Image opaque = random_floats(257, 3, {"R", "G", "B"}), clear = opaque;
  clear.channels.push_back(float_channel("A", std::vector<float>(257 * 3, 0.25f)));
  for (std::size_t c = 0; c < 3; ++c)
    for (float& value : clear.channels[c].floats()) value *= 0.25f;  // exact
  for (int y = 0; y < 3; ++y) {
    std::vector<std::uint8_t> plain(257 * 3), straight(257 * 4);
    srgb8_row(*color_planes(opaque), y, false, plain.data());
    srgb8_row(*color_planes(clear), y, true, straight.data());
    for (std::size_t x = 0; x < 257; ++x) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(straight[4 * x + c], plain[3 * x + c]) << x;
      ASSERT_EQ(straight[4 * x + 3], 64);
    }
    std::vector<std::uint16_t> deep(257 * 4);
    srgb16_row(*color_planes(clear), y, true, deep.data());
    for (std::size_t x = 0; x < 257; ++x) {
      ASSERT_EQ(deep[4 * x + 3], 16384);
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(deep[4 * x + c] / 257.0, straight[4 * x + c], 0.51) << x;
    }
  }
}

// ---- What an image may not be ----

template <class AnyImage>
std::string complaint(const AnyImage& image) {
  return refusal_of(ErrorCode::bad_argument, [&] { validate(image); });
}

TEST(Bitmaps, HoldStraightColoursInBytes) {
  Image image = random_floats(3, 2, {"A", "B", "G", "R"});
  const float alphas[] = {1, 0.5f, 0, 2, -1, std::nanf("")}, reds[] = {1, 0.5f, 1, 2, -1, std::nanf("")};
  std::copy_n(alphas, 6, image.channels[0].floats().data());
  for (int c = 1; c < 4; ++c) std::copy_n(reds, 6, image.channels[std::size_t(c)].floats().data());
  const Bitmap bitmap = bitmap_of(image);
  EXPECT_EQ(bitmap.width, 3);
  EXPECT_EQ(bitmap.height, 2);
  const std::vector<std::uint8_t> expected{255, 255, 255, 255, 255, 255, 255, 128, 0, 0, 0, 0,
                                           255, 255, 255, 255, 0,   0,   0,   0,   0, 0, 0, 0};
  EXPECT_EQ(std::vector<std::uint8_t>(bitmap.rgba.begin(), bitmap.rgba.end()), expected);
  image.channels.erase(image.channels.begin());
  EXPECT_EQ(bitmap_of(image).rgba[4 * 1], 188) << "opaque without A: half of the light is 188 of 255";
  EXPECT_EQ(refusal_of(ErrorCode::bad_argument,
                       [&] {
                         (void)bitmap_of(random_ids(3, 2, {"R", "G", "B"}));
                       }),
            "image: has no channels R, G and B of floats");
  for (int value = 0; value < 256; ++value) EXPECT_EQ(srgb8_of_linear(linear_of_srgb(std::uint8_t(value))), value);
}

TEST(RefusedImages, SayWhatIsWrong) {
  EXPECT_EQ(complaint(Image{}), "image: 0 x 0 pixels");
  EXPECT_EQ(complaint(Image{-1, 5, {}}), "image: -1 x 5 pixels");
  EXPECT_EQ(complaint(Image{(1 << 20) + 1, 1, {}}), "image: 1048577 x 1 pixels");
  EXPECT_EQ(complaint(Image{2, 2, {}}), "image: no channels");
  Image image = random_floats(2, 2, {"Z", "W"});
  EXPECT_EQ(complaint(image), "none");
  image.channels[1].name = "Z";
  EXPECT_EQ(complaint(image), "image: two channels are named Z");
  image.channels[1] = id_channel("primitive", {1, 2, 3});
  EXPECT_EQ(complaint(image), "image: channel primitive does not have width x height values");
  EXPECT_EQ(complaint(Bitmap{2, 1, Buffer<std::uint8_t>(7)}), "image: a bitmap needs four bytes for each pixel");
  EXPECT_EQ(complaint(Bitmap{2, 1, Buffer<std::uint8_t>(8)}), "none");
  EXPECT_EQ(complaint(Bitmap{}), "image: 0 x 0 pixels");
}

TEST(RefusedImages, DeepOnesToo) {
  DeepImage deep{2, 1, Buffer<std::uint64_t>(3, std::uint64_t(0)), {}};
  EXPECT_EQ(complaint(deep), "image: no channels");
  deep.channels.push_back(float_channel("Z", {}));
  EXPECT_EQ(complaint(deep), "none") << "no pixel needs to have a sample";
  deep.first[1] = deep.first[2] = 1;
  EXPECT_EQ(complaint(deep), "image: channel Z does not have one value for each sample");
  deep.channels[0] = float_channel("Z", {1});
  deep.channels.push_back(float_channel("Z", {1}));
  EXPECT_EQ(complaint(deep), "image: two channels are named Z");
  deep.channels.pop_back();
  deep.first[1] = 2;
  EXPECT_EQ(complaint(deep),
            "image: a deep image needs the index of each pixel's first sample, ascending from 0, and the number of all "
            "samples");
  deep.first = Buffer<std::uint64_t>();
  EXPECT_EQ(complaint(deep),
            "image: a deep image needs the index of each pixel's first sample, ascending from 0, and the number of all "
            "samples");
}

TEST(RefusedComparisons, NameSizesAndChannels) {
  const auto error = [](const Image& a, const Image& b) {
    std::string message;
    EXPECT_EQ(error_of([&] { (void)compare(a, b); }, &message), ErrorCode::bad_argument);
    return message;
  };
  const Image depth = random_floats(2, 3, {"Z"});
  EXPECT_EQ(error(depth, random_floats(3, 2, {"Z"})), "comparison: the image has 2 x 3 pixels, the reference 3 x 2");
  EXPECT_EQ(error(depth, random_ids(2, 3, {"Z"})), "comparison: the image has channels Z, the reference Z");
  EXPECT_EQ(error(depth, random_floats(2, 3, {"Z", "object"})),
            "comparison: the image has channels Z, the reference Z, object");
  EXPECT_EQ(error(random_floats(2, 3, {"R", "G", "B", "Z"}), depth),
            "comparison: the image has channels R, G, B, Z, the reference Z");
}

}  // namespace
}  // namespace frontmost::test
