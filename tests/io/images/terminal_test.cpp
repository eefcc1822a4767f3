// SPDX-License-Identifier: Apache-2.0
// Pictures as text in a terminal.
#include <algorithm>

#include "support/test_images.h"

namespace frontmost::test {
namespace {

Image colors(int width, int height, const std::vector<float>& r, const std::vector<float>& g,
             const std::vector<float>& b) {
  Image image{width, height, {}};
  image.channels.push_back(float_channel("R", r));
  image.channels.push_back(float_channel("G", g));
  image.channels.push_back(float_channel("B", b));
  return image;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

TEST(Terminal, TwoPixelsMakeOneCharacter) {
  const Image image = colors(1, 2, {1, 0}, {0, 0}, {0, 1});
  EXPECT_EQ(terminal_picture(image, 1, 1), "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m\xE2\x96\x80\x1b[0m\n");
  EXPECT_EQ(terminal_picture(image, 1, 1, false), "\x1b[38;5;196m\x1b[48;5;21m\xE2\x96\x80\x1b[0m\n");
}

TEST(Terminal, ColoursAreWrittenOnlyWhereTheyChange) {
  const Image image = colors(4, 2, std::vector<float>(8, 1), std::vector<float>(8, 1), std::vector<float>(8, 1));
  const std::string text = terminal_picture(image, 4, 1);
  EXPECT_EQ(count(text, "\x1b[38"), 1u);
  EXPECT_EQ(count(text, "\xE2\x96\x80"), 4u);
}

TEST(Terminal, ProportionsAreKept) {
  const Image wide = random_floats(1920, 1080, {"R", "G", "B"});
  const std::string text = terminal_picture(wide, 80, 40);  // 80 x 45 pixels
  EXPECT_EQ(count(text, "\n"), 23u);
  EXPECT_EQ(count(text, "\xE2\x96\x80"), 23u * 80);
  const std::string low = terminal_picture(wide, 200, 9);  // 32 x 18 pixels
  EXPECT_EQ(count(low, "\n"), 9u);
  EXPECT_EQ(count(low, "\xE2\x96\x80"), 9u * 32);
}

TEST(Terminal, MeansAreTakenInLinearLight) {
  // Equal parts of black and white give sRGB 188, however they are arranged, also if cells cut pixels.
  for (const int size : {2, 6, 50}) {
    std::vector<float> checks(std::size_t(size * size));
    for (int i = 0; i < size * size; ++i) checks[std::size_t(i)] = float((i % size + i / size) % 2);
    const std::string text = terminal_picture(colors(size, size, checks, checks, checks), 1, 1);
    EXPECT_NE(text.find("188;188;188"), std::string::npos) << size;
  }
  const std::string thirds = terminal_picture(colors(3, 1, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}), 2, 1);
  EXPECT_NE(thirds.find("\x1b[38;2;213;213;213m"), std::string::npos);  // 2/3 white
}

TEST(Terminal, TransparentPartsAreLeftToTheTerminal) {
  Image image = colors(3, 2, {1, 0, 0, 0, 1, 0}, std::vector<float>(6, 0), std::vector<float>(6, 0));
  image.channels.push_back(float_channel("A", {1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(terminal_picture(image, 3, 1),
            "\x1b[38;2;255;0;0m\xE2\x96\x80\xE2\x96\x84 \x1b[0m\n");  // top only, bottom only, nothing
}

TEST(Terminal, OddValuesAndSmallTerminalsAreFine) {
  Image image = random_floats(100, 1, {"R", "G", "B"});
  add_odd_values(image);
  for (const int columns : {1, 3, 1000})
    for (const int rows : {1, 2, 500}) EXPECT_FALSE(terminal_picture(image, columns, rows, false).empty());
  EXPECT_EQ(error_of([&] { (void)terminal_picture(image, 0, 5); }), ErrorCode::bad_argument);
  EXPECT_EQ(error_of([] { (void)terminal_picture(random_floats(2, 2, {"Z"}), 5, 5); }), ErrorCode::unsupported);
}

}  // namespace
}  // namespace frontmost::test
