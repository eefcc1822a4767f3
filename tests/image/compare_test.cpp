// SPDX-License-Identifier: Apache-2.0
// Comparison with a reference, with known answers.
#include "base/srgb.h"
#include "frontmost/image.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

Image grey(int width, int height, std::uint8_t byte) {
  Image image{width, height, {}};
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back(
        float_channel(name, std::vector<float>(std::size_t(width * height), linear_of_srgb8(byte))));
  return image;
}

TEST(Compare, EqualImagesDoNotDiffer) {
  for (const auto& names : {std::vector<std::string>{"R", "G", "B", "A"}, {"Z"}, {"R", "G", "B", "Z"}}) {
    Image image = random_floats(37, 21, names);
    add_odd_values(image);
    const Comparison result = compare(image, image);
    EXPECT_EQ(result.error, 0.0);
    EXPECT_EQ(result.mean, 0.0);
    EXPECT_EQ(result.differing, 0u);
  }
  const Image ids = random_ids(37, 21, {"object", "primitive"});
  EXPECT_EQ(compare(ids, ids).differing, 0u);
}

TEST(Compare, ColoursAreMeasuredInSrgbSteps) {
  const Image reference = grey(10, 10, 100);
  Image image = reference;
  image.find("G")->floats()[57] = linear_of_srgb8(103);
  image.find("B")->floats()[57] = linear_of_srgb8(90);
  image.find("R")->floats()[80] = linear_of_srgb8(101);
  const Comparison result = compare(image, reference);
  EXPECT_DOUBLE_EQ(result.error, 10 / 255.0);
  EXPECT_NEAR(result.mean, 11 / 255.0 / 100, 1e-15);
  EXPECT_EQ(result.differing, 2u);
  EXPECT_EQ(result.x, 7);
  EXPECT_EQ(result.y, 5);
  EXPECT_EQ(compare(image, reference, 1 / 255.0).differing, 1u);
  EXPECT_EQ(compare(image, reference, 10 / 255.0).differing, 0u);
}

TEST(Compare, LessThanAStepIsNoDifference) {
  const Image reference = grey(4, 4, 100);
  Image image = reference;
  for (float& value : image.channels[0].floats()) value *= 1.0001f;
  EXPECT_EQ(compare(image, reference).error, 0.0);
}

TEST(Compare, OpaqueAndWithoutAlphaAreTheSame) {
  const Image reference = grey(4, 4, 200);
  Image image = reference;
  image.channels.push_back(float_channel("A", std::vector<float>(16, 1.0f)));
  EXPECT_EQ(compare(image, reference).error, 0.0);
  EXPECT_EQ(compare(reference, image).error, 0.0);
  for (Channel& channel : image.channels) channel.floats()[3] = 0;  // transparent, so black
  EXPECT_EQ(compare(image, reference).error, 1.0);
}

TEST(Compare, MapsAreMeasuredInTheirOwnUnit) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Image reference{4, 1, {}}, image{4, 1, {}};
  reference.channels.push_back(float_channel("Z", {1, 2, infinity, nan}));
  image.channels.push_back(float_channel("Z", {1.25f, 2, infinity, nan}));
  EXPECT_EQ(compare(image, reference).error, 0.25);
  EXPECT_EQ(compare(image, reference, 0.25).differing, 0u);
  image.channels[0].floats()[2] = 5;
  EXPECT_EQ(compare(image, reference, 1e30).differing, 1u);
  EXPECT_EQ(compare(image, reference).error, infinity);
  EXPECT_EQ(compare(image, reference).x, 2);
}

TEST(Compare, IdsDifferOrDoNot) {
  const Image reference = random_ids(8, 8, {"object"}, 100);
  Image image = reference;
  image.channels[0].integers()[9] += 1000;
  const Comparison result = compare(image, reference);
  EXPECT_EQ(result.error, 1.0);
  EXPECT_EQ(result.differing, 1u);
  EXPECT_EQ(result.x, 1);
  EXPECT_EQ(result.y, 1);
}

TEST(Compare, WhatCannotBeComparedSaysSo) {
  std::string message;
  EXPECT_EQ(error_of([] { (void)compare(grey(2, 3, 0), grey(3, 2, 0)); }, &message), ErrorCode::bad_argument);
  EXPECT_NE(message.find("2 x 3"), std::string::npos) << message;
  EXPECT_NE(message.find("3 x 2"), std::string::npos) << message;
  EXPECT_EQ(error_of([] { (void)compare(grey(2, 2, 0), random_floats(2, 2, {"Z"})); }, &message),
            ErrorCode::bad_argument);
  EXPECT_NE(message.find("R, G, B"), std::string::npos) << message;
  for (const auto& names : {std::vector<std::string>{"R", "G", "B", "Z"}, {"R", "G"}}) {
    const Image other = random_floats(2, 2, names);
    EXPECT_EQ(error_of([&] { (void)compare(grey(2, 2, 0), other); }), ErrorCode::bad_argument);
    EXPECT_EQ(error_of([&] { (void)difference_image(other, grey(2, 2, 0)); }), ErrorCode::bad_argument);
  }
  EXPECT_EQ(error_of([] { (void)compare(random_floats(2, 2, {"object"}), random_ids(2, 2, {"object"})); }),
            ErrorCode::bad_argument);
  EXPECT_EQ(error_of([] { (void)compare(grey(2, 2, 0), grey(2, 2, 0), -1); }), ErrorCode::bad_argument);
}

TEST(Compare, ThreadsDoNotChangeTheResult) {
  const Image a = random_floats(200, 333, {"Z", "W"});
  Image b = random_floats(200, 333, {"W", "Z"});  // other values, in another order
  std::optional<Comparison> first;
  for (const int threads : {1, 2, 7}) {
    Execution execution;
    execution.threads = threads;
    const Comparison result = compare(a, b, 0.5, execution);
    if (!first) first = result;
    EXPECT_EQ(result.mean, first->mean);
    EXPECT_EQ(result.differing, first->differing);
    EXPECT_EQ(content_hash(difference_image(a, b, 0.5, execution)), content_hash(difference_image(a, b, 0.5)));
  }
  EXPECT_GT(first->differing, 1000u);
}

TEST(Compare, DifferencePictureIsRedWhereItDiffersAndGreyElsewhere) {
  const Image reference = grey(4, 2, 255);
  Image image = reference;
  image.find("R")->floats()[1] = 0;
  image.find("R")->floats()[2] = linear_of_srgb8(254);
  const Image picture = difference_image(image, reference);
  const auto pixel = [&](std::size_t i) {
    return std::vector<float>{picture.find("R")->floats()[i], picture.find("G")->floats()[i],
                              picture.find("B")->floats()[i], picture.find("A")->floats()[i]};
  };
  EXPECT_THAT(pixel(0), testing::ElementsAre(0.25f, 0.25f, 0.25f, 1));
  EXPECT_THAT(pixel(1), testing::ElementsAre(1, 1, 0, 1));  // the greatest: yellow
  EXPECT_EQ(pixel(2)[0], 1.0f);
  EXPECT_LT(pixel(2)[1], 0.001f);
  const Image lenient = difference_image(image, reference, 2 / 255.0);
  EXPECT_EQ(lenient.find("R")->floats()[2], 0.25f);
}

}  // namespace
}  // namespace frontmost::test
