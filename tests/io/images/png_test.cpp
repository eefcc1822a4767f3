// SPDX-License-Identifier: Apache-2.0
// PNG files, read back by libpng itself. The pixels and the meaning of the numbers in maps are promised.
#include <png.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>

#include "base/srgb.h"
#include "image/srgb_pixels.h"
#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

/// A file's pixels as bytes by libpng's own reader, in the file's own channels; no gamma is applied.
struct Decoded {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> bytes;
};

Decoded decode_by_libpng(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
  const bool alpha = image.format & PNG_FORMAT_FLAG_ALPHA, color = image.format & PNG_FORMAT_FLAG_COLOR;
  image.format = color ? (alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB) : PNG_FORMAT_GRAY;
  Decoded decoded{int(image.width), int(image.height), color ? (alpha ? 4 : 3) : 1, {}};
  decoded.bytes.resize(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, decoded.bytes.data(), 0, nullptr)) << image.message;
  return decoded;
}

struct Size {
  int width, height;
};
constexpr Size sizes[] = {{1, 1}, {3, 5}, {17, 1}, {1, 17}, {640, 333}, {16384, 3}, {3, 16384}};

class Png : public testing::Test {
 protected:
  Image round_trip(const Image& image, const SaveOptions& options = {}) {
    save(image, file(), options);
    return load_image(file());
  }
  std::string file() { return folder_.file("a.png"); }
  ScratchFolder folder_;
};

TEST_F(Png, ColoursAreTheNearestSrgbBytes) {
  for (const auto [width, height] : sizes) {
    const Image image = random_floats(width, height, {"R", "G", "B"}, -0.1f, 1.1f);
    save(image, file());
    const Decoded decoded = decode_by_libpng(file());
    ASSERT_EQ(decoded.width, width);
    ASSERT_EQ(decoded.height, height);
    ASSERT_EQ(decoded.channels, 3);
    for (std::size_t i = 0; i < decoded.bytes.size(); ++i)
      ASSERT_EQ(decoded.bytes[i], srgb8_of_linear(image.channels[i % 3].floats()[i / 3])) << "value " << i;
  }
}

TEST_F(Png, AlphaIsStraightAndLeftOutWhereOpaque) {
  Image image{4, 1, {}};
  image.channels.push_back(float_channel("R", {0.5f, 0.25f, 0.3f, 1}));
  image.channels.push_back(float_channel("G", {0.5f, 0.25f, 0.3f, 0}));
  image.channels.push_back(float_channel("B", {0.5f, 0.25f, 0.3f, 0}));
  image.channels.push_back(float_channel("A", {1, 0.5f, 0, 1}));
  save(image, file());
  const Decoded decoded = decode_by_libpng(file());
  ASSERT_EQ(decoded.channels, 4);
  EXPECT_THAT(decoded.bytes, testing::ElementsAre(188, 188, 188, 255, 188, 188, 188, 128, 0, 0, 0, 0, 255, 0, 0, 255));
  for (float& alpha : image.find("A")->floats()) alpha = 1;
  save(image, file());
  EXPECT_EQ(decode_by_libpng(file()).channels, 3);
}

TEST_F(Png, SecondSaveOfWhatWasReadIsTheSameFile) {
  for (const int bits : {8, 16})
    for (const bool transparent : {false, true}) {
      Image image = random_floats(123, 77, {"R", "G", "B", "A"});
      for (std::size_t i = 0; i < image.channels[0].floats().size(); ++i) {
        float& alpha = image.find("A")->floats()[i];
        alpha = transparent ? 0.2f + 0.8f * alpha : 1.0f;
        for (int c = 0; c < 3; ++c) image.channels[std::size_t(c)].floats()[i] *= alpha;
      }
      SaveOptions options;
      options.bits = bits;
      const Image read = round_trip(image, options);
      const std::string first = read_text(file());
      const Image again = round_trip(read, options);
      EXPECT_EQ(read_text(file()) == first, true) << bits << " bits";
      expect_same_bits(again, read);
      for (std::size_t i = 0; i < image.channels[0].floats().size(); ++i)
        ASSERT_NEAR(read.channels[0].floats()[i], image.channels[0].floats()[i], bits == 8 ? 0.006 : 3e-5);
    }
}

TEST_F(Png, OddColoursHaveAStatedValue) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Image image{3, 1, {}};
  for (const char* name : {"R", "G", "B"}) image.channels.push_back(float_channel(name, {infinity, -infinity, nan}));
  save(image, file());
  EXPECT_THAT(decode_by_libpng(file()).bytes, testing::ElementsAre(255, 255, 255, 0, 0, 0, 0, 0, 0));
  image.channels.push_back(float_channel("A", {nan, 1, 1}));
  save(image, file());
  EXPECT_THAT(decode_by_libpng(file()).bytes, testing::ElementsAre(0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0, 255));
}

TEST_F(Png, BytesDoNotDependOnThreads) {
  const Image image = random_floats(1000, 900, {"R", "G", "B", "A"});
  std::string first;
  for (const int threads : {1, 2, 3, 16}) {
    Execution execution;
    execution.threads = threads;
    save(image, file(), {}, execution);
    if (first.empty()) first = read_text(file());
    EXPECT_TRUE(read_text(file()) == first) << threads << " threads";
  }
}

TEST_F(Png, DepthsFillTheRangeAndComeBack) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Image image = random_floats(100, 50, {"Z"}, 2.5f, 7.5f);
  Buffer<float>& depths = image.channels[0].floats();
  depths[0] = infinity;
  depths[1] = 2.5f;
  depths[2] = 7.5f;
  const Image read = round_trip(image);
  ASSERT_EQ(read.channels.size(), 1u);
  ASSERT_EQ(read.channels[0].name, "Z");
  EXPECT_EQ(read.channels[0].floats()[0], infinity);
  EXPECT_NEAR(read.channels[0].floats()[1], 2.5f, 1e-6);
  EXPECT_NEAR(read.channels[0].floats()[2], 7.5f, 1e-6);
  for (std::size_t i = 3; i < depths.size(); ++i)
    ASSERT_NEAR(read.channels[0].floats()[i], depths[i], 5.0 / 65534 / 2 + 1e-6) << i;
}

TEST_F(Png, DepthsByScaleAreWhatTheCallerSays) {
  Image image{5, 1, {}};
  const float infinity = std::numeric_limits<float>::infinity();
  image.channels.push_back(float_channel("distance", {1.0f, 1.2344f, 65.535f, 1e-9f, infinity}));
  SaveOptions millimetres;
  millimetres.depth_scale = 1000;
  const Image read = round_trip(image, millimetres);
  EXPECT_EQ(read.channels[0].name, "distance");
  const Buffer<float>& depths = read.channels[0].floats();
  EXPECT_THAT(std::vector<float>(depths.begin(), depths.end()),
              testing::ElementsAre(1.0f, 1.234f, 65.535f, 0.001f, infinity));
  image.channels[0].floats()[3] = 65.536f;
  std::string message;
  EXPECT_EQ(error_of([&] { save(image, file(), millimetres); }, &message), ErrorCode::limit_exceeded);
  EXPECT_NE(message.find("65.536"), std::string::npos) << message;
  millimetres.depth_scale = -1;
  EXPECT_EQ(error_of([&] { save(image, file(), millimetres); }), ErrorCode::bad_argument);
  expect_same_bits(load_image(file()), read);  // the previous file is still there
}

TEST_F(Png, DepthsOfNothingAndOfAPlaneAreFine) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float depth : {infinity, 3.25f, 0.0f, -2.0f}) {
    Image image{2, 2, {}};
    image.channels.push_back(float_channel("Z", {depth, depth, depth, depth}));
    expect_same_bits(round_trip(image), image);
  }
}

TEST_F(Png, IdsComeBackToTheBit) {
  for (const auto [width, height] : sizes) {
    Image image = random_ids(width, height, {"object"}, 65534);
    image.channels[0].integers()[0] = no_index;
    expect_same_bits(round_trip(image), image);
  }
  std::string message;
  Image image = random_ids(3, 3, {"primitive"}, 10);
  image.channels[0].integers()[4] = 65535;
  EXPECT_EQ(error_of([&] { save(image, file()); }, &message), ErrorCode::limit_exceeded);
  EXPECT_NE(message.find("65535"), std::string::npos) << message;
}

TEST_F(Png, IdsAreStoredPlusOne) {
  Image image{3, 1, {}};
  image.channels.push_back(id_channel("object", {0, 299, no_index}));
  save(image, file());
  png_image decoded{};
  decoded.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&decoded, file().c_str()));
  EXPECT_EQ(decoded.format, unsigned(PNG_FORMAT_LINEAR_Y));  // 16-bit grey
  decoded.format = PNG_FORMAT_LINEAR_Y;
  std::uint16_t values[3];
  ASSERT_TRUE(png_image_finish_read(&decoded, nullptr, values, 0, nullptr));
  EXPECT_THAT(values, testing::ElementsAre(1, 300, 0));
}

TEST_F(Png, DirectionsComeBackWithZeroExact) {
  for (const int bits : {8, 16}) {
    Image image = random_floats(40, 30, {"N.X", "N.Y", "N.Z"}, -1, 1);
    for (Channel& channel : image.channels) channel.floats()[7] = 0;
    SaveOptions options;
    options.bits = bits;
    const Image read = round_trip(image, options);
    ASSERT_EQ(read.channels.size(), 3u);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(read.channels[c].name, image.channels[c].name);
      EXPECT_EQ(read.channels[c].floats()[7], 0.0f);
      for (std::size_t i = 0; i < 1200; ++i)
        ASSERT_NEAR(read.channels[c].floats()[i], image.channels[c].floats()[i], bits == 8 ? 0.5 / 127 : 0.5 / 32767);
    }
  }
}

TEST_F(Png, OptionsOutOfRangeAreNamed) {
  SaveOptions options;
  options.bits = 12;
  EXPECT_EQ(error_of([&] { save(random_floats(2, 2, {"R", "G", "B"}), file(), options); }), ErrorCode::bad_argument);
  Image image = random_floats(2, 2, {"R", "G", "B", "Z"});
  std::string message;
  EXPECT_EQ(error_of([&] { save(image, file()); }, &message), ErrorCode::unsupported);
  EXPECT_NE(message.find("R, G, B, Z"), std::string::npos) << message;
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_F(Png, ABitmapsFileIsThatOfTheImage) {
  const auto bytes_of = [](const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (const bool opaque : {false, true}) {
    const Image image = random_floats(211, 1300, {"R", "G", "B", "A"}, opaque ? 1.0f : 0.0f, opaque ? 1.5f : 1.0f);
    Bitmap bitmap{image.width, image.height, Buffer<std::uint8_t>(std::size_t(4 * image.width * image.height))};
    for (int y = 0; y < image.height; ++y)
      srgb8_row(color_planes(image).value(), y, true, bitmap.rgba.data() + 4 * y * image.width);
    save(image, file());
    const std::string expected = bytes_of(file());
    save(bitmap, file());
    EXPECT_EQ(bytes_of(file()), expected);
    EXPECT_EQ(decode_by_libpng(file()).channels, opaque ? 3 : 4);
  }
}

TEST_F(Png, BitmapsOfOtherSizesOrFormatsAreRefused) {
  const Bitmap bitmap{2, 2, Buffer<std::uint8_t>(15)};
  EXPECT_EQ(error_of([&] { save(bitmap, file()); }), ErrorCode::bad_argument);
  const Bitmap whole{2, 2, Buffer<std::uint8_t>(16)};
  EXPECT_EQ(error_of([&] { save(whole, folder_.file("a.exr")); }), ErrorCode::unsupported);
  EXPECT_EQ(folder_.entry_count(), 0u);
}

// Alpha just below the value that becomes 255: the stored bytes decide whether a picture is opaque.
TEST_F(Png, TheLastAlphaThatIsNotOpaque) {
  const float last = 254.5f / 255;
  for (const float alpha : {last, std::nextafter(last, 1.0f)}) {
    Image image = random_floats(3, 2, {"R", "G", "B", "A"});
    for (float& value : image.channels[3].floats()) value = alpha;
    save(image, file());
    const Decoded decoded = decode_by_libpng(file());
    EXPECT_EQ(decoded.channels, alpha == last ? 4 : 3);
    if (decoded.channels == 4) {
      EXPECT_EQ(decoded.bytes[3], 254);
    }
  }
}

TEST_F(Png, NoiseThatCannotBeCompressedFits) {
  // Compressed strips are largest for bytes of pure noise.
  Image image = random_floats(2000, 300, {"R", "G", "B"});
  for (Channel& channel : image.channels)
    for (float& value : channel.floats()) value = linear_of_srgb8(std::uint8_t(value * 256));
  save(image, file());
  const Decoded decoded = decode_by_libpng(file());
  for (std::size_t i = 0; i < decoded.bytes.size(); ++i)
    ASSERT_EQ(decoded.bytes[i], srgb8_of_linear(image.channels[i % 3].floats()[i / 3]));
}

}  // namespace
}  // namespace frontmost::test
