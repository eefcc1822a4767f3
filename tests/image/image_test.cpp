// SPDX-License-Identifier: Apache-2.0
// Channels by name, checks, and the content hash.
#include "frontmost/image.h"

#include <set>

#include "support/test_images.h"

namespace frontmost::test {
namespace {

TEST(Image, ChannelsAreFoundByName) {
  Image image = random_floats(2, 2, {"R", "G"});
  EXPECT_EQ(image.find("G"), &image.channels[1]);
  EXPECT_EQ(std::as_const(image).find("R"), &image.channels[0]);
  EXPECT_EQ(image.find("r"), nullptr);
  EXPECT_EQ(Image{}.find(""), nullptr);
}

TEST(Image, WrongSizesAreNamed) {
  std::string message;
  Image image = random_floats(2, 3, {"R", "G"});
  EXPECT_NO_THROW(validate(image));
  image.channels[1].values = Buffer<float>(5);
  EXPECT_EQ(error_of([&] { validate(image); }, &message), ErrorCode::bad_argument);
  EXPECT_NE(message.find("channel G"), std::string::npos) << message;
  EXPECT_EQ(error_of([] { validate(Image{}); }), ErrorCode::bad_argument);
  EXPECT_EQ(error_of([] { validate(Image{1, 1, {}}); }), ErrorCode::bad_argument);
  image = random_floats(2, 2, {"R", "R"});
  EXPECT_EQ(error_of([&] { validate(image); }), ErrorCode::bad_argument);
}

TEST(Image, HashTellsEverythingApart) {
  std::set<std::uint64_t> hashes;
  const auto add = [&](const Image& image) { EXPECT_TRUE(hashes.insert(content_hash(image)).second); };
  const Image image = random_floats(4, 3, {"R", "G"});
  add(image);
  add(random_floats(3, 4, {"R", "G"}));
  add(random_floats(12, 1, {"R", "G"}));
  Image renamed = image;
  renamed.channels[1].name = "B";
  add(renamed);
  Image swapped = image;
  std::swap(swapped.channels[0].values, swapped.channels[1].values);
  add(swapped);
  for (std::size_t i = 0; i < 12; ++i) {
    Image other = image;
    float& value = other.channels[1].floats()[i];
    value = std::nextafter(value, 2.0f);
    add(other);
  }
  Image zero{1, 1, {}}, zero_id{1, 1, {}};
  zero.channels.push_back(float_channel("Z", {0}));
  zero_id.channels.push_back(id_channel("Z", {0}));
  add(zero);
  add(zero_id);
}

TEST(Image, HashIsTheSameForEqualImagesAndForEveryNan) {
  EXPECT_EQ(content_hash(random_floats(40, 30, {"Z"})), content_hash(random_floats(40, 30, {"Z"})));
  Image nan{1, 1, {}};
  nan.channels.push_back(float_channel("Z", {std::nanf("")}));
  const std::uint64_t hash = content_hash(nan);
  nan.channels[0].floats()[0] = -std::nanf("7");
  EXPECT_EQ(content_hash(nan), hash);
}

TEST(Image, HashIsKnown) {
  // FNV-1a over words, by hand: width, height, name length, 'Z', kind, one value of 1.0f.
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const std::uint32_t word : {1u, 1u, 1u, unsigned('Z'), 0u, 0x3F800000u}) hash = (hash ^ word) * 0x100000001B3u;
  Image image{1, 1, {}};
  image.channels.push_back(float_channel("Z", {1.0f}));
  EXPECT_EQ(content_hash(image), hash ^ (hash >> 32));
}

DeepImage deep_image() {
  DeepImage image;
  image.width = 2, image.height = 1;
  image.first = Buffer<std::uint64_t>(3);
  for (std::size_t i = 0; i < 3; ++i) image.first[i] = 2 * i;  // two samples a pixel
  image.channels = {float_channel("Z", {1, 2, 3, 4}), id_channel("primitive", {7, 8, 9, 10})};
  return image;
}

TEST(DeepImages, HashTellsEverythingApart) {
  std::set<std::uint64_t> hashes;
  const auto add = [&](const DeepImage& image) {
    EXPECT_NO_THROW(validate(image));
    EXPECT_TRUE(hashes.insert(content_hash(image)).second);
  };
  const DeepImage image = deep_image();
  add(image);
  EXPECT_EQ(content_hash(image), content_hash(deep_image()));
  DeepImage uneven = image;
  uneven.first[1] = 1;  // one sample, then three: the same values
  add(uneven);
  DeepImage deeper = image;
  deeper.channels[0].floats()[3] = 5;
  add(deeper);
  DeepImage other_id = image;
  other_id.channels[1].integers()[0] = 8;
  add(other_id);
  DeepImage renamed = image;
  renamed.channels[1].name = "object";
  add(renamed);
  DeepImage upright = image;
  std::swap(upright.width, upright.height);
  add(upright);
}

TEST(DeepImages, WrongBeginningsAndChannelsAreNamed) {
  std::string message;
  const auto complaint = [&](const DeepImage& image) {
    EXPECT_EQ(error_of([&] { validate(image); }, &message), ErrorCode::bad_argument);
    return message;
  };
  const char* const order =
      "a deep image needs the index of each pixel's first sample, ascending from 0, and the number of all samples";
  DeepImage image = deep_image();
  image.first = Buffer<std::uint64_t>(2, 0);
  EXPECT_NE(complaint(image).find(order), std::string::npos) << message;
  image = deep_image();
  image.first[1] = 5;
  EXPECT_NE(complaint(image).find(order), std::string::npos) << message;
  image = deep_image();
  image.first[0] = 1;
  EXPECT_NE(complaint(image).find(order), std::string::npos) << message;
  image = deep_image();
  image.channels[1].values = Buffer<std::uint32_t>(3, 0u);
  EXPECT_NE(complaint(image).find("primitive"), std::string::npos) << message;
  image = deep_image();
  image.height = 0;
  EXPECT_EQ(error_of([&] { validate(image); }), ErrorCode::bad_argument);
}

}  // namespace
}  // namespace frontmost::test
