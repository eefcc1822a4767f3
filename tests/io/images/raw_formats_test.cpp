// SPDX-License-Identifier: Apache-2.0
// EXR, PFM and NPY keep every bit; the test reads PFM and NPY by its own short code.
#include <functional>
#include <sstream>

#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

constexpr std::pair<int, int> raw_sizes[] = {{1, 1}, {3, 5}, {17, 1}, {1, 17}, {64, 33}, {16384, 2}};

class RawFormats : public testing::Test {
 protected:
  Image round_trip(const Image& image, const std::string& name) {
    save(image, folder_.file(name));
    return load_image(folder_.file(name));
  }
  ScratchFolder folder_;
};

#ifdef FRONTMOST_HAS_OPENEXR
TEST_F(RawFormats, ExrKeepsAllChannelsToTheBit) {
  for (const auto& [width, height] : raw_sizes) {
    Image image = random_floats(width, height, {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z"}, -10, 10);
    add_odd_values(image);
    image.channels.push_back(std::move(random_ids(width, height, {"primitive"}).channels[0]));
    image.channels.push_back(std::move(random_ids(width, height, {"object"}).channels[0]));
    const Image read = round_trip(image, "all.exr");
    expect_same_bits(read, image);
    EXPECT_EQ(read.channels[0].name, "R");  // colours come first, in their usual order
    EXPECT_EQ(read.channels[3].name, "A");
  }
}

// Several strips of several chunks; the last strip and the last chunk are short.
TEST_F(RawFormats, ExrIsTheSameForAnyNumberOfThreads) {
  Image image = random_floats(5, 201, {"R", "G", "B"});
  for (std::size_t i = 0; i < 500; ++i) image.channels[0].floats()[i] = 0;  // chunks that do shrink
  image.channels.push_back(std::move(random_ids(5, 201, {"primitive"}).channels[0]));
  save(image, folder_.file("1.exr"), {}, {.threads = 1});
  save(image, folder_.file("3.exr"), {}, {.threads = 3});
  EXPECT_TRUE(read_text(folder_.file("1.exr")) == read_text(folder_.file("3.exr")));
  expect_same_bits(load_image(folder_.file("3.exr")), image);
}

TEST_F(RawFormats, ExrNamesWhatItCannotHold) {
  Image image = random_floats(2, 2, {""});
  EXPECT_EQ(error_of([&] { save(image, folder_.file("a.exr")); }), ErrorCode::unsupported);
  EXPECT_EQ(folder_.entry_count(), 0u);
}
#else
TEST_F(RawFormats, ExrIsRefusedByBuildsWithoutIt) {
  std::string message;
  EXPECT_EQ(error_of([&] { save(random_floats(2, 2, {"Z"}), folder_.file("a.exr")); }, &message),
            ErrorCode::unsupported);
  EXPECT_NE(message.find("FRONTMOST_OPENEXR"), std::string::npos);
  EXPECT_EQ(folder_.entry_count(), 0u);
}
#endif

TEST_F(RawFormats, NpyAndPfmKeepEveryBit) {
  for (const auto& [width, height] : raw_sizes) {
    for (const auto& names : {std::vector<std::string>{"Z"}, {"R", "G", "B"}}) {
      Image image = random_floats(width, height, names, -1e6, 1e6);
      add_odd_values(image);
      expect_same_bits(round_trip(image, "a.pfm"), image);
      expect_same_bits(round_trip(image, "a.npy"), image);
    }
    for (const auto& names : {std::vector<std::string>{"primitive"}, {"0", "1"}, {"0", "1", "2"}}) {
      const Image image = random_ids(width, height, names);
      expect_same_bits(round_trip(image, "ids.npy"), image);
    }
    const Image colors = random_floats(width, height, {"R", "G", "B", "A"});
    expect_same_bits(round_trip(colors, "rgba.npy"), colors);
  }
}

TEST_F(RawFormats, PfmStartsAtTheBottomLeft) {
  // Two columns, three rows, numbered in reading order.
  const Image image{2, 3, {}};
  Image numbered = image;
  numbered.channels.push_back(float_channel("Z", {0, 1, 2, 3, 4, 5}));
  save(numbered, folder_.file("a.pfm"));
  const std::string text = read_text(folder_.file("a.pfm"));
  const std::string header = "Pf\n2 3\n-1.0\n";
  ASSERT_EQ(text.substr(0, header.size()), header);
  ASSERT_EQ(text.size(), header.size() + 6 * 4);
  float values[6];
  std::memcpy(values, text.data() + header.size(), sizeof values);
  EXPECT_THAT(values, testing::ElementsAre(4, 5, 2, 3, 0, 1));
}

TEST_F(RawFormats, PfmInBigEndianIsRead) {
  write_text(folder_.file("a.pfm"), std::string("Pf\n2 1\n1.0\n\x3f\x80\0\0\x40\0\0\0", 19));
  const Image image = load_image(folder_.file("a.pfm"));
  EXPECT_EQ(image.channels[0].floats()[0], 1.0f);
  EXPECT_EQ(image.channels[0].floats()[1], 2.0f);
}

TEST_F(RawFormats, NpyIsWhatNumPyWrites) {
  Image image{3, 2, {}};
  image.channels.push_back(id_channel("object", {0, 1, 2, 3, 4, no_index}));
  save(image, folder_.file("a.npy"));
  const std::string text = read_text(folder_.file("a.npy"));
  ASSERT_EQ(text.size(), 128u + 6 * 4);
  EXPECT_EQ(text.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
  EXPECT_EQ(int(text[8]) + 256 * int(text[9]), 128 - 10);
  EXPECT_EQ(text.substr(10, 62), "{'descr': '<u4', 'fortran_order': False, 'shape': (2, 3), }   ");
  EXPECT_EQ(text[127], '\n');
  std::uint32_t last;
  std::memcpy(&last, &text[128 + 5 * 4], 4);
  EXPECT_EQ(last, no_index);
}

TEST_F(RawFormats, NpyChannelsLieSideBySide) {
  Image image{2, 1, {}};
  image.channels.push_back(float_channel("R", {1, 2}));
  image.channels.push_back(float_channel("G", {3, 4}));
  save(image, folder_.file("a.npy"));
  const std::string text = read_text(folder_.file("a.npy"));
  EXPECT_NE(text.find("'shape': (1, 2, 2)"), std::string::npos);
  float values[4];
  std::memcpy(values, &text[128], sizeof values);
  EXPECT_THAT(values, testing::ElementsAre(1, 3, 2, 4));
}

TEST_F(RawFormats, WhatTheyCannotHoldIsNamed) {
  std::string message;
  const Image four = random_floats(2, 2, {"R", "G", "B", "A"});
  EXPECT_EQ(error_of([&] { save(four, folder_.file("a.pfm")); }, &message), ErrorCode::unsupported);
  EXPECT_NE(message.find("R, G, B, A"), std::string::npos) << message;
  EXPECT_EQ(error_of([&] { save(random_ids(2, 2, {"object"}), folder_.file("a.pfm")); }), ErrorCode::unsupported);
  Image mixed = random_floats(2, 2, {"Z"});
  mixed.channels.push_back(std::move(random_ids(2, 2, {"object"}).channels[0]));
  EXPECT_EQ(error_of([&] { save(mixed, folder_.file("a.npy")); }, &message), ErrorCode::unsupported);
  EXPECT_NE(message.find("mixture"), std::string::npos) << message;
  EXPECT_EQ(error_of([&] { save(mixed, folder_.file("a.png")); }), ErrorCode::unsupported);
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_F(RawFormats, FilesOfTheWrongLengthAreNamed) {
  save(random_floats(4, 4, {"Z"}), folder_.file("a.npy"));
  save(random_floats(4, 4, {"Z"}), folder_.file("a.pfm"));
  for (const char* name : {"a.npy", "a.pfm"}) {
    const std::string whole = read_text(folder_.file(name));
    for (const std::string& text : {whole + "x", whole.substr(0, whole.size() - 1)}) {
      write_text(folder_.file(name), text);
      std::string message;
      EXPECT_EQ(error_of([&] { (void)load_image(folder_.file(name)); }, &message), ErrorCode::file_malformed);
      EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

TEST_F(RawFormats, ForeignArraysAreUnsupportedNotBroken) {
  const auto npy = [](const std::string& dictionary) {
    return std::string("\x93NUMPY\x01\0", 8) + char(dictionary.size()) + '\0' + dictionary;
  };
  for (const char* dictionary : {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }",
                                 "{'descr': '<f4', 'fortran_order': True, 'shape': (1, 1), }"}) {
    const std::string text = npy(dictionary) + std::string(8, '\0');
    EXPECT_EQ(error_of([&] { (void)load_image(std::as_bytes(std::span(text)), "memory"); }), ErrorCode::unsupported);
  }
  const std::string absurd = npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4294967295, 4294967295), }");
  EXPECT_EQ(error_of([&] { (void)load_image(std::as_bytes(std::span(absurd)), "memory"); }), ErrorCode::limit_exceeded);
}

}  // namespace
}  // namespace frontmost::test
