// SPDX-License-Identifier: Apache-2.0
// Environments: every format gives the same light, in one shape, without values that sums cannot bear.
#include <cmath>

#include "support/radiance_maker.h"
#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;

class Environment : public testing::Test {
 protected:
  Image through(const Image& image, const std::string& name) {
    save(image, folder_.file(name));
    return load_environment(folder_.file(name));
  }
  /// Error message without the file's name.
  std::string refusal(const Image& image, const std::string& name, ErrorCode code = ErrorCode::unsupported) {
    std::string message;
    EXPECT_EQ(error_of([&] { (void)through(image, name); }, &message), code);
    EXPECT_EQ(message.substr(0, folder_.file(name).size()), folder_.file(name));
    return message.substr(std::min(message.size(), folder_.file(name).size()));
  }
  ScratchFolder folder_;
};

std::vector<float> values_of(const Image& image, const char* channel) {
  const Buffer<float>& values = image.find(channel)->floats();
  return {values.begin(), values.end()};
}

TEST_F(Environment, RadianceIsTakenAsItIs) {
  const RadianceRows rows = {{{128, 64, 32, 129}, {255, 0, 0, 140}}};
  write_text(folder_.file("a.hdr"), plain_radiance(rows));
  const Image environment = load_environment(folder_.file("a.hdr"));
  ASSERT_EQ(environment.channels.size(), 3u);
  EXPECT_THAT(values_of(environment, "R"), ElementsAre(1, 4080));
  EXPECT_THAT(values_of(environment, "G"), ElementsAre(0.5f, 0));
  EXPECT_THAT(values_of(environment, "B"), ElementsAre(0.25f, 0));
  const std::string bytes = plain_radiance(rows);
  expect_same_bits(load_environment(std::as_bytes(std::span(bytes)), "m"), environment);
}

#ifdef FRONTMOST_HAS_OPENEXR
TEST_F(Environment, OpenExrGivesItsColoursAlone) {
  Image image = random_floats(8, 4, {"R", "G", "B"}, 0, 5);
  const Image colours = image;
  image.channels.push_back(std::move(random_floats(8, 4, {"A"}).channels[0]));
  image.channels.push_back(std::move(random_floats(8, 4, {"Z"}).channels[0]));
  const Image environment = through(image, "a.exr");
  EXPECT_EQ(environment.channels.size(), 3u);
  expect_same_bits(environment, colours);
}

TEST_F(Environment, GreyIsAllThree) {
  const Image image = random_floats(8, 4, {"Y"});
  const Image environment = through(image, "a.exr");
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(values_of(environment, name), values_of(image, "Y"));
}

TEST_F(Environment, ChannelsThatAreNoLightAreRefused) {
  EXPECT_EQ(refusal(random_floats(4, 2, {"R", "G", "Z"}), "a.exr"),
            ": an environment has channels R, G and B, or Y, not R, G, Z");
  EXPECT_EQ(refusal(random_ids(4, 2, {"R", "G", "B"}), "a.exr"),
            ": an environment has channels R, G and B, or Y, not R, G, B");
}
#endif

TEST_F(Environment, OddValuesHaveAStatedMeaning) {
  Image image = random_floats(6, 3, {"R", "G", "B"});
  add_odd_values(image);  // inf, -inf, NaN, -0, 1e-45, 3e38
  image.channels[0].floats()[6] = -1;
  const std::vector<float> red = values_of(through(image, "a.pfm"), "R");
  EXPECT_THAT(std::vector<float>(red.begin(), red.begin() + 7),
              ElementsAre(65504, 0, 0, 0, 1e-45f, max_environment_value, 0));
  EXPECT_FALSE(std::signbit(red[3])) << "no zero has a sign";
}

TEST_F(Environment, OtherShapesAreRefused) {
  for (const auto& [width, height] : {std::pair(4, 4), {2, 12}, {12, 2}, {3, 4}, {4, 3}, {2, 4}, {5, 2}})
    EXPECT_EQ(refusal(random_floats(width, height, {"R", "G", "B"}), "a.pfm"),
              ": an environment must be twice as wide as high (equirectangular), not " + std::to_string(width) + " x " +
                  std::to_string(height));
}

TEST_F(Environment, AnyFormatWithColoursWillDo) {
  const Image image = random_floats(8, 4, {"R", "G", "B"});
  expect_same_bits(through(image, "a.pfm"), image);
  expect_same_bits(through(image, "a.npy"), image);
  const Image from_png = through(image, "a.png");
  EXPECT_EQ(from_png.channels.size(), 3u);
  EXPECT_NEAR(from_png.channels[1].floats()[5], image.channels[1].floats()[5], 0.005);
  EXPECT_EQ(refusal(random_floats(4, 2, {"Z"}), "a.pfm"), ": an environment has channels R, G and B, or Y, not Z");
}

TEST_F(Environment, FilesThatAreNotThere) {
  EXPECT_EQ(error_of([&] { (void)load_environment(folder_.file("none.hdr")); }), ErrorCode::file_unreadable);
  write_text(folder_.file("text.hdr"), "not a picture");
  EXPECT_EQ(error_of([&] { (void)load_environment(folder_.file("text.hdr")); }), ErrorCode::file_malformed);
}

}  // namespace
}  // namespace frontmost::test
