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

}  // namespace
}  // namespace frontmost::test
