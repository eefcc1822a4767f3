// SPDX-License-Identifier: Apache-2.0
// Radiance pictures: known values, every way of packing rows, and the error messages for broken ones.
#include <cmath>

#include "support/radiance_maker.h"
#include "support/seeds.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

Image read_hdr(const std::string& bytes) { return load_image(std::as_bytes(std::span(bytes)), "m"); }

/// Noise, and long and short runs of pixels and of single components.
RadianceRows random_rows(std::size_t width, std::size_t height, unsigned seed) {
  std::mt19937 random(test::noted_seed(seed));
  RadianceRows rows(height, std::vector<RadiancePixel>(width));
  for (auto& row : rows) {
    RadiancePixel pixel = {9, 200, 3, 130};
    for (RadiancePixel& place : row) {
      const unsigned what = random() % 40;
      // Not 1, 1, 1, which marks a run.
      if (what < 4) pixel[what] = std::uint8_t(2 + random() % 250);
      if (what == 5) pixel = {2, std::uint8_t(random() | 2), std::uint8_t(random()), std::uint8_t(random())};
      place = pixel;
    }
  }
  return rows;
}

void expect_values(const Image& image, const RadianceRows& rows) {
  ASSERT_EQ(std::size_t(image.width), rows[0].size());
  ASSERT_EQ(std::size_t(image.height), rows.size());
  ASSERT_EQ(image.channels.size(), 3u);
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < rows[0].size(); ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const RadiancePixel& pixel = rows[y][x];
        const double expected = pixel[3] ? pixel[c] / 256.0 * std::pow(2.0, pixel[3] - 128) : 0;
        ASSERT_EQ(image.channels[c].floats()[y * rows[0].size() + x], float(expected)) << x << ", " << y;
      }
}

TEST(Radiance, KnownValues) {
  const Image image =
      read_hdr(plain_radiance({{{128, 64, 255, 129}, {200, 100, 50, 0}, {1, 255, 0, 1}, {255, 1, 0, 255}}}));
  const Buffer<float>&r = image.find("R")->floats(), &g = image.find("G")->floats(), &b = image.find("B")->floats();
  EXPECT_EQ(r[0], 1.0f);
  EXPECT_EQ(g[0], 0.5f);
  EXPECT_EQ(b[0], 255.0f / 128);
  EXPECT_EQ(r[1], 0.0f) << "exponent 0 is black";
  EXPECT_EQ(r[2], std::ldexp(1.0f, -135)) << "the least, too small for a normal float";
  EXPECT_EQ(r[3], std::ldexp(255.0f, 119)) << "the greatest";
}

TEST(Radiance, RowsOfEveryKind) {
  for (const std::size_t width : {1u, 2u, 7u, 8u, 9u, 127u, 128u, 129u, 255u, 256u, 257u, 700u, 1024u}) {
    SCOPED_TRACE(width);
    const RadianceRows rows = random_rows(width, 5, unsigned(width));
    expect_values(read_hdr(plain_radiance(rows)), rows);
    expect_values(read_hdr(repeating_radiance(rows)), rows);
    if (width >= 8) expect_values(read_hdr(packed_radiance(rows)), rows);
  }
  const RadianceRows black(2, std::vector<RadiancePixel>(16384, {0, 0, 0, 0}));
  expect_values(read_hdr(repeating_radiance(black)), black);
  expect_values(read_hdr(packed_radiance(black)), black);
}

TEST(Radiance, RowsMayBePackedEachInItsWay) {
  const RadianceRows rows = random_rows(50, 3, 1);
  std::string bytes = radiance_header(rows);
  const std::size_t header = bytes.size();
  bytes += plain_radiance({rows[0]}).substr(header);
  bytes += packed_radiance({rows[1]}).substr(header);
  bytes += repeating_radiance({rows[2]}).substr(header);
  expect_values(read_hdr(bytes), rows);
}

TEST(Radiance, PicturesMayBeginAtAnyCorner) {
  const std::string pixels =
      bytes_of({10, 0, 0, 136}) + bytes_of({20, 0, 0, 136}) + bytes_of({30, 0, 0, 136}) + bytes_of({40, 0, 0, 136});
  const auto red = [&](const std::string& size) {
    const Image image = read_hdr(radiance_header(size) + pixels);
    const Buffer<float>& values = image.channels[0].floats();
    return std::vector<float>(values.begin(), values.end());
  };
  using testing::ElementsAre;
  EXPECT_THAT(red("-Y 2 +X 2"), ElementsAre(10, 20, 30, 40));
  EXPECT_THAT(red("+Y 2 +X 2"), ElementsAre(30, 40, 10, 20));
  EXPECT_THAT(red("-Y 2 -X 2"), ElementsAre(20, 10, 40, 30));
  EXPECT_THAT(red("+Y 2 -X 2"), ElementsAre(40, 30, 20, 10));
  EXPECT_EQ(image_error(radiance_header("+X 2 -Y 2") + pixels),
            "unsupported, m: Radiance: pictures stored column by column are not supported");
}

TEST(Radiance, HeadersAsTheyAreWritten) {
  const std::string pixel = bytes_of({128, 128, 128, 129});
  for (const char* header : {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", "#?RGBE\n\n-Y 1 +X 1\n",
                             "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n",
                             "#?RADIANCE\nGAMMA=1\nVIEW= -vtl\n# any\n\n-Y 1 +X 1\n"})
    EXPECT_EQ(read_hdr(header + pixel).channels[0].floats()[0], 1.0f) << header;
}

TEST(Radiance, ErrorsSayWhere) {
  const std::string bad = "malformed, m: Radiance: ";
  EXPECT_EQ(image_error("#?RADIANCE"), bad + "the header is cut short");
  EXPECT_EQ(image_error("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"), bad + "the header is cut short");
  EXPECT_EQ(image_error(radiance_header("-Y 1 +X 1", "32-bit_rle_xyze") + "1234"),
            "unsupported, m: Radiance: format \"32-bit_rle_xyze\" is not supported, only 32-bit_rle_rgbe");
  for (const char* size : {"", "-Y", "-Y 1", "-Y 1 +X", "-Y 1 +Z 1", "Y 1 X 1", "-Y -1 +X 1", "-Y 1 +Y 1",
                           "-Y 99999999999 +X 1", "-Y x +X 1"})
    EXPECT_EQ(image_error(radiance_header(size) + "1234"),
              bad + "\"" + size + "\" is not a size such as -Y 512 +X 1024");
  const std::string wide = radiance_header("-Y 1 +X 9"), head = std::string("\2\2\0\11", 4);
  EXPECT_EQ(image_error(wide + std::string("\2\2\0\12", 4) + "1234567890"), bad + "row 0 has 10 pixels, not 9");
  EXPECT_EQ(image_error(wide + head +
                        "\x8A"
                        "1234567890"),
            bad + "row 0: a run of 10 bytes at 0 of 9");
  EXPECT_EQ(image_error(wide + head +
                        "\x85"
                        "1\x85"
                        "234567890"),
            bad + "row 0: a run of 5 bytes at 5 of 9");
  EXPECT_EQ(image_error(wide + head + std::string(10, '\0')), bad + "row 0: a run of 0 bytes at 0 of 9");
  EXPECT_EQ(image_error(wide + "\1\1\1\5"
                               "12345678"),
            bad + "row 0: a run of 5 pixels at 0 of 9");
  EXPECT_EQ(image_error(wide + "abcd\1\1\1\11"
                               "12345678"),
            bad + "row 0: a run of 9 pixels at 1 of 9");
  EXPECT_EQ(image_error(wide + "abcd\1\1\1\2\1\1\1\1"
                               "1234"),
            bad + "row 0: a run of 256 pixels at 3 of 9");
  EXPECT_EQ(image_error(wide + "abcdefghijkl"), bad + "row 0 is cut short");
  EXPECT_EQ(image_error(plain_radiance(random_rows(9, 3, 0)).substr(0, radiance_header("-Y 3 +X 9").size() + 75)),
            bad + "row 2 is cut short");
}

TEST(Radiance, SizesThatTheBytesCannotHoldGetNoMemory) {
  EXPECT_EQ(image_error(radiance_header("-Y 16384 +X 16384") + std::string(1000, '\2')),
            "malformed, m: Radiance: 1000 bytes cannot hold 16384 x 16384 pixels");
  EXPECT_EQ(image_error(radiance_header("-Y 16385 +X 1") + "1234"),
            "limit, m: Radiance: 1 x 16385 pixels, more than 16384 on a side or 268435456 in all");
  EXPECT_EQ(image_error(radiance_header("-Y 0 +X 4") + "1234"),
            "malformed, m: Radiance: the image has 4 x 0 pixels; width and height must be at least 1");
}

}  // namespace
}  // namespace frontmost::test
