// SPDX-License-Identifier: Apache-2.0
// JPEG and WebP, read back by libjpeg and libwebp: colours within a stated error, and exact alpha. Content that the
// formats cannot hold is refused before a file exists.
#include <cmath>

#include "base/srgb.h"
#include "io/images/formats.h"
#include "support/effort.h"
#include "support/scratch_folder.h"
#include "support/test_images.h"
#ifdef FRONTMOST_HAS_WEBP
#include <webp/decode.h>
#endif

namespace frontmost::test {
namespace {

/// A bright disc with a soft shade and a hard rim on a coloured ground; with alpha, a wedge that fades out.
Image disc(int width, int height, bool with_alpha) {
  Image image{width, height, {}};
  for (const char* name : {"R", "G", "B", "A"})
    image.channels.push_back({name, Buffer<float>(std::size_t(width) * std::size_t(height), 1.0f)});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = 2.0 * x / width - 1, v = 2.0 * y / height - 1, far = u * u + v * v;
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const float alpha = with_alpha ? float(x) / float(width) : 1.0f;
      const float shade = float(far < 0.5 ? 1 - far : 0.2);
      const float color[] = {shade, far < 0.5 ? 0.6f * shade : 0.3f, 0.4f};
      for (std::size_t c = 0; c < 3; ++c) image.channels[c].floats()[i] = color[c] * alpha;
      image.channels[3].floats()[i] = alpha;
    }
  if (!with_alpha) image.channels.pop_back();
  return image;
}

/// Pixels of a PNG of the same image, four bytes each.
std::vector<std::uint8_t> bytes_by_png(const Image& image) {
  const ScratchFolder folder;
  save(image, folder.file("a.png"));
  const std::string png = read_text(folder.file("a.png"));
  const Texture texture = decode_texture(std::as_bytes(std::span(png)), "png");
  const auto* first = &texture.pixels.front().x;
  return {first, first + 4 * texture.pixels.size()};
}

struct DecodedColors {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

DecodedColors decode_jpeg_file(const std::string& bytes) {
  const Texture texture = decode_texture(std::as_bytes(std::span(bytes)), "jpeg");
  const auto* first = &texture.pixels.front().x;
  return {texture.width, texture.height, {first, first + 4 * texture.pixels.size()}};
}

struct LossyFormat {
  std::string suffix;
  DecodedColors (*decode)(const std::string&);
  int most_side;
};

#ifdef FRONTMOST_HAS_WEBP
DecodedColors decode_webp_file(const std::string& bytes) {
  DecodedColors decoded;
  std::uint8_t* pixels = ::WebPDecodeRGBA(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(),
                                          &decoded.width, &decoded.height);
  EXPECT_NE(pixels, nullptr);
  if (pixels) decoded.rgba.assign(pixels, pixels + 4 * std::ptrdiff_t(decoded.width) * decoded.height);
  ::WebPFree(pixels);
  return decoded;
}
#endif

class Lossy : public testing::TestWithParam<LossyFormat> {
 protected:
  std::string file() { return folder_.file("a" + GetParam().suffix); }
  std::string saved(const Image& image, const SaveOptions& options = {}, const Execution& execution = {}) {
    save(image, file(), options, execution);
    return read_text(file());
  }
  ScratchFolder folder_;
};

struct Distance {
  double mean = 0;  ///< root mean square error of colours
  int most = 0, most_alpha = 0;
};
Distance distance_of(const std::vector<std::uint8_t>& actual, const std::vector<std::uint8_t>& expected) {
  Distance distance;
  EXPECT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < std::min(actual.size(), expected.size()); ++i) {
    const int difference = std::abs(int(actual[i]) - int(expected[i]));
    int& most = i % 4 == 3 ? distance.most_alpha : distance.most;
    most = std::max(most, difference);
    if (i % 4 != 3) distance.mean += difference * difference;
  }
  distance.mean = std::sqrt(distance.mean / (0.75 * double(expected.size())));
  return distance;
}

TEST_P(Lossy, PicturesStayWithinAStatedError) {
  const Image image = disc(320, 200, false);
  const DecodedColors decoded = GetParam().decode(saved(image));
  EXPECT_EQ(decoded.width, 320);
  EXPECT_EQ(decoded.height, 200);
  const Distance distance = distance_of(decoded.rgba, bytes_by_png(image));
  EXPECT_LT(distance.mean, 3);
  EXPECT_GT(distance.mean, 0) << "the picture is not compared with itself";
  EXPECT_EQ(distance.most_alpha, 0);
}

TEST_P(Lossy, MoreQualityIsNearerAndLarger) {
  const Image image = disc(320, 200, false);
  const std::vector<std::uint8_t> expected = bytes_by_png(image);
  double last = 1e9;
  std::size_t last_size = 0;
  for (const int quality : {1, 50, 90, 100}) {
    SaveOptions options;
    options.quality = quality;
    const std::string bytes = saved(image, options);
    const double mean = distance_of(GetParam().decode(bytes).rgba, expected).mean;
    EXPECT_LT(mean, last) << quality;
    EXPECT_GT(bytes.size(), last_size) << quality;
    last = mean;
    last_size = bytes.size();
  }
}

TEST_P(Lossy, SmallAndNarrowPictures) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 17}, {17, 1}, {15, 9}, {16, 16}, {33, 31}}) {
    const Image image = disc(width, height, false);
    const DecodedColors decoded = GetParam().decode(saved(image));
    EXPECT_EQ(decoded.width, width);
    EXPECT_EQ(decoded.height, height);
    EXPECT_LT(distance_of(decoded.rgba, bytes_by_png(image)).mean, 12) << width << " x " << height;
  }
}

TEST_P(Lossy, ABitmapsFileIsThatOfTheImage) {
  const Image image = disc(100, 70, false);
  const std::string expected = saved(image);
  Bitmap bitmap{100, 70, Buffer<std::uint8_t>(4 * 100 * 70)};
  const std::vector<std::uint8_t> bytes = bytes_by_png(image);
  std::copy(bytes.begin(), bytes.end(), bitmap.rgba.begin());
  save(bitmap, file());
  EXPECT_TRUE(read_text(file()) == expected);
}

TEST_P(Lossy, BytesDoNotDependOnThreads) {
  const Image image = disc(300, 300, false);
  const std::string expected = saved(image, {}, {.threads = 1});
  for (const int threads : {2, 3, 16}) EXPECT_TRUE(saved(image, {}, {.threads = threads}) == expected) << threads;
}

TEST_P(Lossy, WhatIsNoPictureIsRefused) {
  const std::string format = GetParam().suffix == ".jpg" ? "JPEG" : "WebP";
  for (const Image& image :
       {random_floats(3, 2, {"Z"}), random_floats(3, 2, {"N.X", "N.Y", "N.Z"}), random_ids(3, 2, {"object"}),
        random_floats(3, 2, {"R", "G", "B", "Z"}), random_ids(3, 2, {"R", "G", "B"})}) {
    std::string message;
    EXPECT_EQ(error_of([&] { (void)saved(image); }, &message), ErrorCode::unsupported);
    EXPECT_EQ(message.substr(0, message.find(", not")), file() + ": " + format + " holds pictures, of R, G, B and A");
  }
  EXPECT_EQ(folder_.entry_count(), 0u) << "nothing is left behind";
}

TEST_P(Lossy, SidesAreLimited) {
  const int most = GetParam().most_side;
  for (const bool wide : {false, true}) {
    const auto line = [&](int length) { return disc(wide ? length : 1, wide ? 1 : length, false); };
    EXPECT_EQ(GetParam().decode(saved(line(16000))).rgba.size(), 64000u);
    EXPECT_FALSE(saved(line(most)).empty());
    std::filesystem::remove(file());
    std::string message;
    EXPECT_EQ(error_of([&] { (void)saved(line(most + 1)); }, &message), ErrorCode::limit_exceeded);
    const std::string words = "holds at most " + std::to_string(most) + " pixels on a side, not ";
    EXPECT_NE(message.find(words + std::to_string(most + 1)), std::string::npos) << message;
    EXPECT_EQ(folder_.entry_count(), 0u);
  }
}

TEST_P(Lossy, QualitiesOutOfRangeAreNamed) {
  for (const int quality : {-1, 0, 101}) {
    SaveOptions options;
    options.quality = quality;
    std::string message;
    EXPECT_EQ(error_of([&] { (void)saved(disc(9, 9, false), options); }, &message), ErrorCode::bad_argument);
    EXPECT_EQ(message, file() + ": the quality is 1 to 100, not " + std::to_string(quality));
  }
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_P(Lossy, WorkCanBeEndedAnywhere) {
  const Image image = disc(200, 200, false);
  CountingWatch all;
  save(image, file(), {}, all.execution());
  std::filesystem::remove(file());
  EXPECT_GT(all.asked(), 5u);
  for (std::size_t last = 1; last <= all.asked(); last += 1 + all.asked() / 20) {
    CountingWatch some(last);
    EXPECT_EQ(error_of([&] { save(image, file(), {}, some.execution()); }), ErrorCode::cancelled) << last;
    EXPECT_EQ(folder_.entry_count(), 0u) << "nothing is left behind";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Lossy,
                         testing::Values(
#ifdef FRONTMOST_HAS_WEBP
                             LossyFormat{".webp", decode_webp_file, 16383},
#endif
                             LossyFormat{".jpg", decode_jpeg_file, 65500}),
                         [](const auto& format) { return format.param.suffix.substr(1); });

TEST(Jpeg, BothSuffixesAreJpeg) {
  const ScratchFolder folder;
  const Image image = disc(8, 8, false);
  for (const char* name : {"a.jpg", "a.jpeg", "a.JPG"}) {
    save(image, folder.file(name));
    EXPECT_EQ(read_text(folder.file(name)).substr(0, 3), "\xff\xd8\xff") << name;
  }
}

TEST(Jpeg, AlphaIsRefusedAndLeftOutWhereOpaque) {
  const ScratchFolder folder;
  std::string message;
  EXPECT_EQ(error_of([&] { save(disc(20, 20, true), folder.file("a.jpg")); }, &message), ErrorCode::unsupported);
  EXPECT_EQ(message, folder.file("a.jpg") +
                         ": JPEG holds no alpha, and parts of the picture are transparent; write PNG or WebP");
  EXPECT_EQ(folder.entry_count(), 0u);
  Image opaque = disc(20, 20, true);
  for (float& alpha : opaque.find("A")->floats()) alpha = 1;
  save(opaque, folder.file("a.jpg"));
  EXPECT_EQ(folder.entry_count(), 1u);
}

#ifdef FRONTMOST_HAS_WEBP
TEST(WebP, AlphaIsKeptAsItIs) {
  const ScratchFolder folder;
  const Image image = disc(120, 90, true);
  save(image, folder.file("a.webp"));
  const DecodedColors decoded = decode_webp_file(read_text(folder.file("a.webp")));
  const std::vector<std::uint8_t> expected = bytes_by_png(image);
  EXPECT_EQ(distance_of(decoded.rgba, expected).most_alpha, 0);
  double sum = 0;
  for (std::size_t i = 0; i < expected.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c)
      sum += std::abs(int(decoded.rgba[i + c]) - int(expected[i + c])) * expected[i + 3] / 255.0;
  EXPECT_LT(sum / (0.75 * double(expected.size())), 3) << "colours where they are seen";
}
#else
TEST(WebP, ABuildWithoutItNamesThePackage) {
  const ScratchFolder folder;
  std::string message;
  EXPECT_EQ(error_of([&] { save(disc(9, 9, false), folder.file("a.webp")); }, &message), ErrorCode::unsupported);
  EXPECT_NE(message.find("libwebp-dev"), std::string::npos) << message;
  EXPECT_EQ(folder.entry_count(), 0u);
}
#endif

}  // namespace
}  // namespace frontmost::test
