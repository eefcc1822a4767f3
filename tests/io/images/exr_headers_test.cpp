// SPDX-License-Identifier: Apache-2.0
// OpenEXR headers: files of other programs that are read here, and headers that promise more than their file holds.
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <half.h>

#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

std::string number(std::int32_t value) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + number(std::int32_t(value.size())) + value;
}

std::string channel(const std::string& name) {
  return name + '\0' + number(2) + std::string(4, '\0') + number(1) + number(1);
}

/// A header without pixels: enough to be refused.
std::string header(const std::string& attributes, std::int32_t version = 2) {
  return "\x76\x2f\x31\x01" + number(version) + attributes + '\0';
}

std::string window(std::int32_t left, std::int32_t top, std::int32_t right, std::int32_t bottom) {
  return attribute("dataWindow", "box2i", number(left) + number(top) + number(right) + number(bottom));
}

const std::string one_channel = attribute("channels", "chlist", channel("Z") + '\0');

TEST(ExrHeader, KindsOfFilesThatAreNotRead) {
  for (const std::int32_t flag : {0x200, 0x800, 0x1000})
    EXPECT_EQ(image_error(header("", 2 | flag)), "unsupported, m: EXR: tiled, deep and multi-part files are not read");
}

TEST(ExrHeader, AttributesAreAsLongAsTheirTypeIs) {
  EXPECT_EQ(image_error(header(attribute("x", "v2f", std::string(7, '\0')))),
            "malformed, m: EXR: an attribute's size does not fit its type v2f");
  EXPECT_EQ(image_error(header(attribute("x", "box2i", std::string(17, '\0')))),
            "malformed, m: EXR: an attribute's size does not fit its type box2i");
  EXPECT_EQ(image_error(header(attribute("x", "preview", "12345678"))),
            "unsupported, m: EXR: attributes of type preview are not read");
  EXPECT_EQ(image_error(header(std::string("x\0int\0", 6) + number(-4))),
            "malformed, m: EXR: attribute x has a negative size");
  EXPECT_EQ(image_error(header(std::string("x\0string\0", 9) + number(1000) + "short")),
            "malformed, m: EXR: the header is cut short");
  EXPECT_EQ(image_error("\x76\x2f\x31\x01" + number(2) + "no zero"), "malformed, m: EXR: the header is cut short");
}

TEST(ExrHeader, ChannelListsAreCounted) {
  EXPECT_EQ(image_error(header(attribute("channels", "chlist", channel("Z") + '\0' + "more"))),
            "malformed, m: EXR: the channel list ends before its attribute");
  EXPECT_EQ(image_error(header(attribute("channels", "chlist", channel("Z").substr(0, 9)))),
            "malformed, m: EXR: the header is cut short");
  EXPECT_EQ(image_error(header(window(0, 0, 1, 1))), "limit, m: EXR: 0 channels; expected 1 to 1024");
  std::string many;
  for (int i = 0; i < 1025; ++i) many += channel("c" + std::to_string(i));
  EXPECT_EQ(image_error(header(window(0, 0, 1, 1) + attribute("channels", "chlist", many + '\0'))),
            "limit, m: EXR: 1025 channels; expected 1 to 1024");
  // Two lists of 600 channels, which the library would add up.
  std::string half;
  for (int i = 0; i < 600; ++i) half += channel("c" + std::to_string(i));
  const std::string list = attribute("channels", "chlist", half + '\0'),
                    more = attribute("others", "chlist", half + '\0');
  EXPECT_EQ(image_error(header(window(0, 0, 1, 1) + list + more)), "limit, m: EXR: 1200 channels; expected 1 to 1024");
}

TEST(ExrHeader, WindowsAreHeldAgainstTheFile) {
  constexpr std::int32_t most = 0x7FFFFFFF, least = -most - 1;
  EXPECT_EQ(image_error(header(one_channel + window(0, 0, -1, 0))),
            "malformed, m: EXR: the image has 0 x 1 pixels; width and height must be at least 1");
  EXPECT_EQ(image_error(header(one_channel + window(5, 5, 4, 3))),
            "malformed, m: EXR: the image has 0 x 0 pixels; width and height must be at least 1");
  EXPECT_EQ(image_error(header(one_channel + window(least, 0, most, 0))).substr(0, 35),
            "limit, m: EXR: 4294967296 x 1 pixel");
  EXPECT_EQ(image_error(header(one_channel + window(-16384, 0, 0, 0))).substr(0, 29), "limit, m: EXR: 16385 x 1 pixe");
  const std::string lying = header(one_channel + window(0, 0, 9999, 9999));
  EXPECT_EQ(image_error(lying), "malformed, m: EXR: " + std::to_string(lying.size()) +
                                    " bytes cannot hold 10000 x 10000 pixels of 1 channels");
  // The library takes the last of two windows.
  const std::string twice = header(one_channel + window(0, 0, 1, 1) + window(0, 0, 9999, 9999));
  EXPECT_EQ(image_error(twice), "malformed, m: EXR: " + std::to_string(twice.size()) +
                                    " bytes cannot hold 10000 x 10000 pixels of 1 channels");
  // Wavelets have no bound of compression, so even such a file gets some memory: up to 64 MiB.
  const std::string wavelets = attribute("compression", "compression", "\4");
  const std::string large = header(one_channel + wavelets + window(0, 0, 4095, 4096));
  EXPECT_EQ(image_error(large), "malformed, m: EXR: " + std::to_string(large.size()) +
                                    " bytes cannot hold 4096 x 4097 pixels of 1 channels");
  EXPECT_EQ(image_error(header(one_channel + wavelets + window(0, 0, 4095, 4095))).find("cannot hold"),
            std::string::npos)
      << "that is for the library to refuse";
}

// ---- Files of others ----

template <class T>
T value_of(int x, int y) {
  return T(10 * y + x);
}

template <class T>
void write_window(const std::string& path, Imf::PixelType type, const Imath::Box2i& box, Imf::Compression compression) {
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), box);
  header.compression() = compression;
  header.channels().insert("Z", Imf::Channel(type));
  const int width = box.max.x - box.min.x + 1, height = box.max.y - box.min.y + 1;
  Imf::Array2D<T> values(height, width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) values[y][x] = value_of<T>(x, y);
  Imf::FrameBuffer frame;
  char* origin = reinterpret_cast<char*>(&values[0][0]) - (std::ptrdiff_t(box.min.y) * width + box.min.x) * sizeof(T);
  frame.insert("Z", Imf::Slice(type, origin, sizeof(T), sizeof(T) * std::size_t(width)));
  Imf::OutputFile out(path.c_str(), header, 0);
  out.setFrameBuffer(frame);
  out.writePixels(height);
}

// A data window is the part of the picture that a file holds; this part becomes the image, wherever it lies.
TEST(ExrFiles, WindowsAwayFromTheOrigin) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  for (const Imath::V2i& corner : {Imath::V2i(0, 0), Imath::V2i(5, 7), Imath::V2i(-30, -4), Imath::V2i(90, 300)}) {
    write_window<float>(path, Imf::FLOAT, {corner, corner + Imath::V2i(3, 2)}, Imf::ZIP_COMPRESSION);
    const Image image = load_image(path);
    ASSERT_EQ(image.width, 4);
    ASSERT_EQ(image.height, 3);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        ASSERT_EQ(image.channels[0].floats()[std::size_t(4 * y + x)], value_of<float>(x, y)) << corner.x;
  }
}

TEST(ExrFiles, EveryTypeAndCompressionWithoutLoss) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  const Imath::Box2i box({0, 0}, {9, 99});
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    write_window<half>(path, Imf::HALF, box, compression);
    const Image halves = load_image(path);  // up to 999: exact in half precision
    write_window<std::uint32_t>(path, Imf::UINT, box, compression);
    const Image integers = load_image(path);
    ASSERT_TRUE(integers.channels.at(0).is_integer());
    for (std::size_t i = 0; i < 1000; ++i) {
      ASSERT_EQ(halves.channels[0].floats()[i], float(i)) << compression;
      ASSERT_EQ(integers.channels[0].integers()[i], i) << compression;
    }
  }
}

TEST(ExrFiles, SubsampledChannelsAreNamed) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  Imf::Header header(4, 4);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("BY", Imf::Channel(Imf::FLOAT, 2, 2));
  {
    std::vector<float> values(16, 1.0f);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 16));
    frame.insert("BY", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 8, 2, 2));
    Imf::OutputFile out(path.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writePixels(4);
  }
  EXPECT_EQ(image_error(read_text(path)), "unsupported, m: EXR: channel BY is subsampled");
}

TEST(ExrFiles, TiledFilesAreNamed) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  {
    Imf::Header header(4, 4);
    header.setTileDescription({2, 2, Imf::ONE_LEVEL});
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    std::vector<float> values(16, 1.0f);
    Imf::FrameBuffer frame;
    frame.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 16));
    Imf::TiledOutputFile out(path.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writeTiles(0, 1, 0, 1);
  }
  EXPECT_EQ(image_error(read_text(path)), "unsupported, m: EXR: tiled, deep and multi-part files are not read");
}

TEST(ExrFiles, AttributesOfOthersDoNoHarm) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.exr");
  {
    Imf::Header header(2, 1);
    header.insert("software", Imf::StringAttribute("somebody's"));
    header.insert("comments", Imf::StringAttribute(std::string(100000, 'x')));
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const float values[] = {1, 2};
    Imf::FrameBuffer frame;
    frame.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(values)), 4, 8));
    Imf::OutputFile out(path.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writePixels(1);
  }
  EXPECT_EQ(load_image(path).channels[0].floats()[1], 2.0f);
}

// load_image() takes at most a thousand channels, so save() writes no more.
TEST(ExrFiles, ManyChannels) {
  const ScratchFolder folder;
  std::vector<std::string> names;
  for (int i = 0; i < 1024; ++i) names.push_back("c" + std::to_string(i));
  const Image image = random_floats(3, 2, names);
  save(image, folder.file("a.exr"));
  expect_same_bits(load_image(folder.file("a.exr")), image);
  names.push_back("one more");
  const std::string path = folder.file("b.exr");
  std::string message;
  EXPECT_EQ(error_of([&] { save(random_floats(3, 2, names), path); }, &message), ErrorCode::unsupported);
  EXPECT_EQ(message, path + ": EXR: more than 1024 channels");
  EXPECT_EQ(folder.entry_count(), 1u);
}

}  // namespace
}  // namespace frontmost::test
