// SPDX-License-Identifier: Apache-2.0
// Headers of NPY and PFM files: valid ones, and the error messages for invalid ones.
#include <bit>
#include <cstring>

#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

struct Outcome {
  Image image;
  std::string error;  ///< empty: the image was read
  ErrorCode code{};
};

Outcome read(const std::string& bytes) {
  // The memory has exactly that size, so that AddressSanitizer detects every byte read beyond it.
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  const std::vector<std::byte> exact(first, first + bytes.size());
  Outcome outcome;
  try {
    outcome.image = load_image(exact, "m");
  } catch (const Error& error) {
    outcome.error = error.what();
    outcome.code = error.code();
  }
  return outcome;
}

template <class T>
std::string raw(std::initializer_list<T> values, bool big_endian = false) {
  std::string bytes;
  for (T value : values) {
    char parts[sizeof value];
    std::memcpy(parts, &value, sizeof value);
    if (big_endian) std::reverse(std::begin(parts), std::end(parts));
    bytes.append(parts, sizeof value);
  }
  return bytes;
}

/// An NPY header of any version around a dictionary, followed by `numbers`.
std::string npy(const std::string& dictionary, const std::string& numbers, int version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += {char(version), '\0', char(dictionary.size() & 0xFF), char(dictionary.size() >> 8)};
  if (version > 1) bytes += std::string(2, '\0');
  return bytes + dictionary + numbers;
}

std::string npy_of_shape(const std::string& shape, const std::string& numbers) {
  return npy("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }", numbers);
}

TEST(NpyHeader, VersionsOneToThree) {
  const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }";
  const std::string numbers = raw<float>({1.5f, -2});
  for (const int version : {1, 2, 3}) {
    const Outcome outcome = read(npy(dictionary, numbers, version));
    ASSERT_EQ(outcome.error, "") << "version " << version;
    EXPECT_EQ(outcome.image.width, 2);
    EXPECT_EQ(outcome.image.height, 1);
    EXPECT_EQ(outcome.image.channels[0].floats()[1], -2.0f);
  }
  EXPECT_EQ(image_error(npy(dictionary, numbers, 0)), "unsupported, m: NPY: version 0");
  EXPECT_EQ(image_error(npy(dictionary, numbers, 4)), "unsupported, m: NPY: version 4");
  // From version 2 on the length has four bytes; all four count.
  std::string large = npy(dictionary, numbers, 2);
  large[10] = 1;
  EXPECT_EQ(image_error(large), "malformed, m: NPY: the header is cut short");
  EXPECT_EQ(image_error(npy(dictionary, numbers).substr(0, 11)), "malformed, m: NPY: the header is cut short");
  EXPECT_EQ(image_error(npy(dictionary, "").substr(0, 30)), "malformed, m: NPY: the header is cut short");
}

TEST(NpyHeader, BothByteOrdersAndTypes) {
  const auto typed = [](const char* type, const std::string& numbers) {
    return read(npy(std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (1, 2), }", numbers));
  };
  const Outcome floats = typed(">f4", raw<float>({1, -0.25f}, true));
  ASSERT_EQ(floats.error, "");
  EXPECT_EQ(floats.image.channels[0].name, "Z");
  EXPECT_EQ(floats.image.channels[0].floats()[1], -0.25f);
  const Outcome ids = typed(">u4", raw<std::uint32_t>({7, 0xFFFFFFFE}, true));
  ASSERT_EQ(ids.error, "");
  EXPECT_EQ(ids.image.channels[0].name, "primitive");
  EXPECT_EQ(ids.image.channels[0].integers()[0], 7u);
  EXPECT_EQ(ids.image.channels[0].integers()[1], 0xFFFFFFFEu);
  for (const char* type : {"<f8", "<i4", "|u1", "=f4", "f4"})
    EXPECT_EQ(typed(type, raw<float>({1, 2})).error, "m: NPY: only float32 (f4) and uint32 (u4) arrays are read");
}

TEST(NpyHeader, ChannelsGetTheNamesOfTheirNumber) {
  const auto names = [](int channels, const char* type) {
    const std::string shape = "(1, 1, " + std::to_string(channels) + ")";
    const Outcome outcome =
        read(npy(std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': " + shape + ", }",
                 std::string(std::size_t(channels) * 4, '\0')));
    std::string list;
    for (const Channel& channel : outcome.image.channels) list += channel.name + " ";
    return outcome.error + list;
  };
  EXPECT_EQ(names(1, "<f4"), "Z ");
  EXPECT_EQ(names(2, "<f4"), "0 1 ");
  EXPECT_EQ(names(3, "<f4"), "R G B ");
  EXPECT_EQ(names(4, "<f4"), "R G B A ");
  EXPECT_EQ(names(5, "<f4"), "0 1 2 3 4 ");
  EXPECT_EQ(names(1, "<u4"), "primitive ");
  EXPECT_EQ(names(3, "<u4"), "0 1 2 ") << "integers are no colours";
  EXPECT_EQ(names(0, "<f4"), "m: NPY: 0 channels; expected 1 to 1024");
  EXPECT_EQ(names(1025, "<f4"), "m: NPY: 1025 channels; expected 1 to 1024");
  EXPECT_EQ(names(1024, "<f4").substr(0, 6), "0 1 2 ");
}

TEST(NpyHeader, KeysThatAreMissing) {
  const std::string four = raw<float>({1});
  EXPECT_EQ(image_error(npy("{'fortran_order': False, 'shape': (1, 1), }", four)),
            "malformed, m: NPY: the header has no 'descr'");
  EXPECT_EQ(image_error(npy("{'descr': '<f4', 'shape': (1, 1), }", four)),
            "malformed, m: NPY: the header has no 'fortran_order'");
  EXPECT_EQ(image_error(npy("{'descr': '<f4', 'fortran_order': False, }", four)),
            "malformed, m: NPY: the header has no 'shape'");
  EXPECT_EQ(image_error(npy("{'descr': '<f4', 'fortran_order': False, 'shape'", four)),
            "malformed, m: NPY: the header has no 'shape'");
  EXPECT_EQ(image_error(npy("{'descr': '<f4', 'fortran_order': False, 'shape':   ", four)),
            "malformed, m: NPY: the header has no 'shape'");
  EXPECT_EQ(image_error(npy("{'shape': (1, 1), 'fortran_order': False, 'descr': '<f4'}", four)), "read")
      << "in any order";
  EXPECT_EQ(image_error(npy("{'descr': '<f4', 'fortran_order': True, 'shape': (1, 1), }", four)),
            "unsupported, m: NPY: arrays in Fortran order are not read");
}

TEST(NpyHeader, Shapes) {
  const std::string four = raw<float>({1});
  EXPECT_EQ(image_error(npy_of_shape("(1, 1)", four)), "read");
  EXPECT_EQ(image_error(npy_of_shape("(1,1,1,)", four)), "read");
  for (const char* shape : {"1", "[1, 1]", "(1, 1"})
    EXPECT_EQ(image_error(npy_of_shape(shape, four)), "malformed, m: NPY: the shape is not a tuple") << shape;
  for (const char* shape : {"()", "(1,)", "(1, 1, 1, 1)", "(-1, 1)", "(1.0, 1)", "(a, b)", "(4294967296, 1)"})
    EXPECT_EQ(image_error(npy_of_shape(shape, four)), "malformed, m: NPY: the shape is not (height, width[, channels])")
        << shape;
  EXPECT_EQ(image_error(npy_of_shape("(0, 3)", "")),
            "malformed, m: NPY: the image has 3 x 0 pixels; width and height must be at least 1");
  EXPECT_EQ(image_error(npy_of_shape("(3, 0)", "")),
            "malformed, m: NPY: the image has 0 x 3 pixels; width and height must be at least 1");
  EXPECT_EQ(image_error(npy_of_shape("(1, 2)", four)),
            "malformed, m: NPY: the header asks for 8 bytes of numbers, but 4 follow");
  EXPECT_EQ(image_error(npy_of_shape("(16384, 16384, 1024)", four)),
            "malformed, m: NPY: the header asks for 1099511627776 bytes of numbers, but 4 follow");
  EXPECT_EQ(image_error(npy_of_shape("(1, 16385)", four)).substr(0, 32), "limit, m: NPY: 16385 x 1 pixels,");
}

TEST(PfmHeader, WordsEndWithOneBlankEach) {
  const std::string one = raw<float>({0.5f});
  for (const char* header : {"Pf\n1 1\n-1.0\n", "Pf 1 1 -1 ", "Pf\r1\t1\n-0.25\n"}) {
    const Outcome outcome = read(header + one);
    ASSERT_EQ(outcome.error, "") << header;
    EXPECT_EQ(outcome.image.channels[0].floats()[0], 0.5f);
  }
  // A second blank is part of the numbers, which may begin with any byte.
  EXPECT_EQ(image_error("Pf\n1 1\n-1.0\n\n" + one),
            "malformed, m: PFM: the header asks for 4 bytes of numbers, but 5 follow");
  const float blanks = read("Pf\n1 1\n-1.0\n    ").image.channels.at(0).floats()[0];
  EXPECT_EQ(raw<float>({blanks}), "    ");
}

TEST(PfmHeader, OtherKindsAreNotTakenForOneOfThese) {
  const std::string one = raw<float>({0.5f});
  EXPECT_EQ(image_error("PF4\n1 1\n-1.0\n" + one + one + one + one), "malformed, m: PFM: neither PF nor Pf");
  EXPECT_EQ(image_error("Pfx\n1 1\n-1.0\n" + one), "malformed, m: PFM: neither PF nor Pf");
}

TEST(PfmHeader, WhatIsNotANumber) {
  const std::string one = raw<float>({0.5f});
  EXPECT_EQ(image_error("Pf\nx 1\n-1.0\n" + one), "malformed, m: PFM: a size is not a number");
  EXPECT_EQ(image_error("Pf\n1 1x\n-1.0\n" + one), "malformed, m: PFM: a size is not a number");
  EXPECT_EQ(image_error("Pf\n1 -1\n-1.0\n" + one), "malformed, m: PFM: a size is not a number");
  EXPECT_EQ(image_error("Pf\n4294967296 1\n-1.0\n" + one), "malformed, m: PFM: a size is not a number");
  EXPECT_EQ(image_error("Pf\n1 1\n-0.0\n" + one), "malformed, m: PFM: the scale is not a number");
  EXPECT_EQ(image_error("Pf\n1 1\nless\n" + one), "malformed, m: PFM: the scale is not a number");
  EXPECT_EQ(image_error("Pf\n1 1"), "malformed, m: PFM: the header is cut short");
  EXPECT_EQ(image_error("Pf\n1 1\n"), "malformed, m: PFM: the header is cut short");
  EXPECT_EQ(image_error("Pf\n1  1\n-1.0\n" + one), "malformed, m: PFM: the header is cut short");
  EXPECT_EQ(image_error("Pf\n" + std::string(64, '1') + " 1\n-1.0\n"), "malformed, m: PFM: the header is cut short");
  EXPECT_EQ(image_error("PF\n1 0\n-1.0\n"),
            "malformed, m: PFM: the image has 1 x 0 pixels; width and height must be at least 1");
}

TEST(PfmHeader, ThreeChannelsLieSideBySide) {
  // Two rows; the lower one comes first.
  const Outcome outcome = read("PF\n1 2\n1.0\n" + raw<float>({4, 5, 6, 1, 2, 3}, true));
  ASSERT_EQ(outcome.error, "");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(outcome.image.channels[c].name, std::string(1, "RGB"[c]));
    EXPECT_EQ(outcome.image.channels[c].floats()[0], float(c + 1));
    EXPECT_EQ(outcome.image.channels[c].floats()[1], float(c + 4));
  }
}

// Both formats are written in blocks of a megabyte; rows that cross a block's end must not be lost.
TEST(RawBlocks, PicturesOfManyBlocksComeBack) {
  const ScratchFolder folder;
  for (const auto& [width, height] : {std::pair(16384, 17), std::pair(700, 1000), std::pair(1, 16384)}) {
    const Image image = random_floats(width, height, {"R", "G", "B"});
    for (const char* name : {"a.npy", "a.pfm"}) {
      save(image, folder.file(name));
      expect_same_bits(load_image(folder.file(name)), image);
    }
  }
}

}  // namespace
}  // namespace frontmost::test
