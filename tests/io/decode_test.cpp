// SPDX-License-Identifier: Apache-2.0
// Texture images in every flavour, and error messages for broken ones.
#include <gmock/gmock.h>

#include <functional>

#include "io/image_bytes.h"
#include "io/images/formats.h"

namespace frontmost {
namespace {

using test::encode_jpeg;
using test::encode_png;
using test::JpegFlavour;
using test::PngFlavour;
using testing::ElementsAre;
using testing::HasSubstr;
using Pixel = glm::u8vec4;

Texture decode_png_of(const PngFlavour& flavour, std::vector<std::uint8_t> rows) {
  const std::vector<std::byte> bytes = encode_png(flavour, rows);
  EXPECT_EQ(texture_size(bytes, "t.png"), glm::ivec2(flavour.width, flavour.height));
  return decode_texture(bytes, "t.png");
}

std::string error_of(std::span<const std::byte> bytes, ErrorCode expected = ErrorCode::file_malformed) {
  try {
    (void)decode_texture(bytes, "a.png");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), expected) << error.what();
    EXPECT_THAT(error.what(), testing::StartsWith("a.png: "));
    return error.what();
  }
  return "no error";
}

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

void set_big_endian(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + std::size_t(i)] = std::byte(value >> (24 - 8 * i));
}

/// Recomputes the header's checksum, so that a changed size is not caught by it.
void repair_header(std::vector<std::byte>& png) {
  std::uint32_t crc = ~0u;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= std::uint32_t(png[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  set_big_endian(png, 29, ~crc);
}

TEST(DecodePng, RgbaIsTakenAsItIs) {
  const Texture t = decode_png_of({.width = 2, .height = 2}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
  EXPECT_EQ(t.name, "t.png");
  EXPECT_EQ(glm::ivec2(t.width, t.height), glm::ivec2(2, 2));
  EXPECT_THAT(t.pixels, ElementsAre(Pixel(1, 2, 3, 4), Pixel(5, 6, 7, 8), Pixel(9, 10, 11, 12), Pixel(13, 14, 15, 16)));
}

TEST(DecodePng, RgbGreyAndGreyAlphaAreWidened) {
  EXPECT_THAT(decode_png_of({.color_type = 2}, {10, 20, 30}).pixels, ElementsAre(Pixel(10, 20, 30, 255)));
  EXPECT_THAT(decode_png_of({.color_type = 0}, {77}).pixels, ElementsAre(Pixel(77, 77, 77, 255)));
  EXPECT_THAT(decode_png_of({.color_type = 4}, {77, 9}).pixels, ElementsAre(Pixel(77, 77, 77, 9)));
}

TEST(DecodePng, FewBitsSpanTheWholeRange) {
  EXPECT_THAT(decode_png_of({.width = 4, .color_type = 0, .bits = 2}, {0b00011011}).pixels,
              ElementsAre(Pixel(0, 0, 0, 255), Pixel(85, 85, 85, 255), Pixel(170, 170, 170, 255), Pixel(255)));
  EXPECT_THAT(decode_png_of({.width = 2, .color_type = 0, .bits = 1}, {0b01000000}).pixels,
              ElementsAre(Pixel(0, 0, 0, 255), Pixel(255)));
}

TEST(DecodePng, SixteenBitsAreRoundedToEight) {
  // 0x80FF / 257 = 128.49..., 0x8081 / 257 = 128.004; dropping the low byte would miss 0x01FF -> 2.
  EXPECT_THAT(decode_png_of({.width = 3, .color_type = 0, .bits = 16}, {0x80, 0xFF, 0x01, 0xFF, 0xFF, 0xFF}).pixels,
              ElementsAre(Pixel(128, 128, 128, 255), Pixel(2, 2, 2, 255), Pixel(255)));
}

TEST(DecodePng, PaletteAndTransparentColours) {
  const PngFlavour palette{
      .width = 3, .color_type = 3, .palette = {255, 0, 0, 0, 255, 0, 0, 0, 255}, .transparency = {255, 128}};
  EXPECT_THAT(decode_png_of(palette, {2, 1, 0}).pixels,
              ElementsAre(Pixel(0, 0, 255, 255), Pixel(0, 255, 0, 128), Pixel(255, 0, 0, 255)));
  EXPECT_THAT(decode_png_of({.width = 2, .color_type = 0, .transparent_grey = 5}, {5, 6}).pixels,
              ElementsAre(Pixel(5, 5, 5, 0), Pixel(6, 6, 6, 255)));
}

TEST(DecodePng, InterlacedEqualsPlain) {
  PngFlavour flavour{.width = 13, .height = 11, .color_type = 2};
  std::vector<std::uint8_t> rows(13 * 11 * 3);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = std::uint8_t(i * 37);
  const Texture plain = decode_png_of(flavour, rows);
  flavour.interlaced = true;
  EXPECT_EQ(decode_png_of(flavour, rows).pixels, plain.pixels);
}

TEST(DecodePng, EveryPrefixIsAnError) {
  const std::vector<std::byte> bytes =
      encode_png({.width = 5, .height = 4, .color_type = 0}, std::vector<std::uint8_t>(20, 7));
  for (std::size_t n = 0; n + 1 < bytes.size(); ++n) {
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    EXPECT_THROW((void)decode_texture(prefix, "a.png"), Error) << n << " of " << bytes.size() << " bytes";
  }
}

TEST(DecodePng, SizesAreCheckedBeforeMemoryIsAskedFor) {
  std::vector<std::byte> bytes = encode_png({.color_type = 0}, std::vector<std::uint8_t>{7});
  const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
    set_big_endian(bytes, 16, width);
    set_big_endian(bytes, 20, height);
    repair_header(bytes);
    return bytes;
  };
  EXPECT_THAT(error_of(with_size(16385, 1), ErrorCode::limit_exceeded), HasSubstr("16385 x 1"));
  EXPECT_THAT(error_of(with_size(0x7FFFFFFF, 0x7FFFFFFF), ErrorCode::limit_exceeded), HasSubstr("16384 on a side"));
  EXPECT_THAT(error_of(with_size(16384, 16384)), HasSubstr("cannot hold 16384 x 16384"));
  EXPECT_THAT(error_of(with_size(0, 5)), HasSubstr("PNG: "));
}

std::vector<std::uint8_t> flat_samples(const JpegFlavour& flavour, std::vector<std::uint8_t> sample) {
  std::vector<std::uint8_t> samples;
  for (int i = 0; i < flavour.width * flavour.height; ++i) samples.insert(samples.end(), sample.begin(), sample.end());
  return samples;
}

void expect_flat(const JpegFlavour& flavour, std::vector<std::uint8_t> sample, glm::ivec4 expected) {
  const std::vector<std::byte> bytes = encode_jpeg(flavour, flat_samples(flavour, std::move(sample)));
  EXPECT_EQ(texture_size(bytes, "t.jpg"), glm::ivec2(flavour.width, flavour.height));
  const Texture t = decode_texture(bytes, "t.jpg");
  ASSERT_EQ(t.pixels.size(), std::size_t(flavour.width * flavour.height));
  for (const Pixel& pixel : t.pixels)
    for (int c = 0; c < 4; ++c) ASSERT_NEAR(int(pixel[c]), expected[c], 2) << "channel " << c;
}

TEST(DecodeJpeg, ColourGreyAndInks) {
  for (const bool progressive : {false, true}) {
    expect_flat({.width = 20, .height = 9, .components = 3, .progressive = progressive}, {200, 100, 50},
                {200, 100, 50, 255});
    expect_flat({.width = 20, .height = 9, .components = 1, .progressive = progressive}, {99}, {99, 99, 99, 255});
    // libjpeg writes an Adobe marker with CMYK, which inverts the inks: 255 is no ink.
    expect_flat({.width = 8, .height = 8, .components = 4, .progressive = progressive}, {255, 128, 0, 255},
                {255, 128, 0, 255});
  }
}

TEST(DecodeJpeg, TruncatedIsAnErrorAndNotGrey) {
  const JpegFlavour flavour{.width = 64, .height = 64, .components = 1};
  std::vector<std::uint8_t> samples(64 * 64);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::uint8_t(i * i / 7);
  const std::vector<std::byte> bytes = encode_jpeg(flavour, samples);
  for (std::size_t n = 0; n + 2 < bytes.size(); n += n < 700 ? 1 : 53) {
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    EXPECT_THROW((void)decode_texture(prefix, "a.jpg"), Error) << n << " of " << bytes.size() << " bytes";
  }
}

TEST(DecodeJpeg, ArithmeticCodingIsNamedUnsupported) {
  const JpegFlavour flavour{.width = 8, .height = 8, .components = 1, .arithmetic = true};
  EXPECT_THAT(error_of(encode_jpeg(flavour, flat_samples(flavour, {1})), ErrorCode::unsupported),
              HasSubstr("arithmetic"));
}

TEST(DecodeJpeg, SizeThatTheBytesCannotHoldIsRefused) {
  const JpegFlavour flavour{.width = 8, .height = 8, .components = 1};
  std::vector<std::byte> bytes = encode_jpeg(flavour, flat_samples(flavour, {1}));
  for (std::size_t i = 0; i + 9 < bytes.size(); ++i)
    if (bytes[i] == std::byte{0xFF} && bytes[i + 1] == std::byte{0xC0}) set_big_endian(bytes, i + 5, 0x40004000u);
  EXPECT_THAT(error_of(bytes), HasSubstr("cannot hold 16384 x 16384"));
}

TEST(Decode, JpegScansWithoutEndAreRefused) {
  const JpegFlavour flavour{.width = 16, .height = 16, .components = 3, .progressive = true};
  const std::vector<std::byte> one = encode_jpeg(flavour, std::vector<std::uint8_t>(16 * 16 * 3));
  constexpr std::byte start_of_scan[] = {std::byte{0xFF}, std::byte{0xDA}};
  const auto scan = std::find_end(one.begin(), one.end(), std::begin(start_of_scan), std::end(start_of_scan));
  std::vector<std::byte> many(one.begin(), scan);
  for (int i = 0; i < 300; ++i) many.insert(many.end(), scan, one.end() - 2);
  many.insert(many.end(), one.end() - 2, one.end());
  EXPECT_THAT(error_of(many), HasSubstr("more scans than an image of its size has"));
}

// Red, green, blue and white squares, four by four pixels each, lossless.
constexpr std::string_view quarters(
    "RIFF\x36\0\0\0WEBPVP8L\x2a\0\0\0\x2f\x0f\xc0\x03\0\x1f \x10H\xde\x1f:\x8d\xf9\x17\x10\x14\xfc\x1f\xdd\xfc"
    "Gd\x0f\x80"
    "0\xdbh\x92\x93\x9c\xe4\xbd\xcf \xa2\xffQ\xfa\xc1\xf6\x01",
    62);

class DecodeWebp : public testing::Test {
 protected:
  void SetUp() override {
    if (!decodes_webp(nullptr)) GTEST_SKIP() << "built without libwebp";
  }
};

TEST_F(DecodeWebp, LosslessPixelsAreAsTheyWere) {
  EXPECT_EQ(texture_size(bytes_of(quarters), "t.webp"), glm::ivec2(16, 16));
  const Texture t = decode_texture(bytes_of(quarters), "t.webp");
  ASSERT_THAT(t.pixels, testing::SizeIs(256));
  for (std::size_t i = 0; i < 256; ++i) {
    const bool right = i % 16 >= 8, low = i / 16 >= 8;
    const Pixel expected = low     ? right ? Pixel(255) : Pixel(0, 0, 255, 255)
                               : right ? Pixel(0, 255, 0, 255)
                                   : Pixel(255, 0, 0, 255);
    EXPECT_EQ(t.pixels[i], expected) << i;
  }
}

TEST_F(DecodeWebp, EveryPrefixIsAnError) {
  for (std::size_t n = 12; n < quarters.size(); ++n)
    EXPECT_THAT(error_of(bytes_of(quarters.substr(0, n))), HasSubstr("WebP: ")) << n;
}

TEST_F(DecodeWebp, AnimationsAreNamed) {
  using namespace std::string_view_literals;
  EXPECT_EQ(error_of(bytes_of("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x0f\0\0\x0f\0\0"sv), ErrorCode::unsupported),
            "a.png: WebP: animations are not supported");
}

TEST(Decode, ABuildWithoutLibwebpSaysSo) {
  if (decodes_webp(nullptr)) GTEST_SKIP() << "built with libwebp";
  EXPECT_THAT(error_of(bytes_of(quarters), ErrorCode::unsupported), HasSubstr("libwebp-dev"));
}

TEST(Decode, OtherFormatsAreNamed) {
  using namespace std::string_view_literals;
  const std::pair<std::string_view, const char*> files[] = {
      {"\xABKTX 20\xBB\r\n\x1A\n"sv, "KTX2"},
      {"\xABKTX 11\xBB\r\n\x1A\n"sv, "KTX"},
      {"DDS |"sv, "DDS"},
      {"GIF89a"sv, "GIF"},
      {"BM1234"sv, "BMP"},
      {"\0\0\0\x1C"
       "ftypavif"sv,
       "AVIF"},
      {"II*\0\x08\0\0\0"sv, "TIFF"},
      {"MM\0*\0\0\0\x08"sv, "TIFF"},
      {"8BPS\0\x01"sv, "PSD"},
      {"\x76\x2f\x31\x01\x02\0\0\0"sv, "OpenEXR"},
      {"#?RADIANCE\n"sv, "Radiance"},
  };
  for (const auto& [bytes, format] : files) {
    EXPECT_EQ(error_of(bytes_of(bytes), ErrorCode::unsupported),
              std::string("a.png: ") + format + " images are not supported, only PNG, JPEG and WebP");
  }
}

TEST(Decode, TextsThatBeginLikeASignatureAreNoneOfTheseFormats) {
  for (const char* text : {"MMXXVI", "II*x", "Bm", "GIF", "8BP", "#?RADIANT", "RIFF....WAVE", "RIFF....WEB"})
    EXPECT_EQ(error_of(bytes_of(text)), "a.png: neither PNG nor JPEG nor WebP") << text;
}

TEST(Decode, EmptyAndUnknownAreErrors) {
  EXPECT_EQ(error_of({}), "a.png: the image is empty");
  EXPECT_THAT(error_of(bytes_of("hello")), HasSubstr("neither PNG nor JPEG"));
}

TEST(Decode, MutationsNeverCrash) {
  std::vector<std::uint8_t> samples(16 * 16 * 3);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::uint8_t(i * i / 5);
  const std::vector<std::byte> seeds[] = {
      encode_png({.width = 16, .height = 16, .color_type = 2, .interlaced = true}, samples),
      encode_jpeg({.width = 16, .height = 16, .components = 3}, samples),
      encode_jpeg({.width = 16, .height = 16, .components = 3, .progressive = true}, samples)};
  std::size_t refused = 0;
  std::uint32_t random = 1;
  for (const std::vector<std::byte>& seed : seeds)
    for (int round = 0; round < 1000; ++round) {
      std::vector<std::byte> bytes = seed;
      for (int change = 0; change <= round % 4; ++change) {
        random = random * 1664525u + 1013904223u;
        bytes[(random >> 8) % bytes.size()] = std::byte(random);
      }
      try {
        const Texture t = decode_texture(bytes, "t");
        EXPECT_EQ(t.pixels.size(), std::size_t(t.width) * std::size_t(t.height));
      } catch (const Error&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 500u);
}

}  // namespace
}  // namespace frontmost
