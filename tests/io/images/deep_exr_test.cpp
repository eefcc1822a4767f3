// SPDX-License-Identifier: Apache-2.0
// Deep OpenEXR files, read back by OpenEXR's own deep interface.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <gtest/gtest.h>

#include "frontmost/files.h"
#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "support/random_scene.h"
#include "support/scratch_folder.h"

namespace frontmost::test {
namespace {

/// An image of up to five samples a pixel, with floats and integers.
DeepImage random_image(int width, int height, std::uint64_t seed) {
  Random random(seed);
  DeepImage image{width, height, Buffer<std::uint64_t>(std::size_t(width * height) + 1, std::uint64_t(0)), {}};
  for (std::size_t i = 0; i + 1 < image.first.size(); ++i)
    image.first[i + 1] = image.first[i] + std::uint64_t(random.below(6));
  const std::size_t count = image.first[image.first.size() - 1];
  for (const char* name : {"A", "Z"}) {
    image.channels.push_back({name, Buffer<float>(count)});
    for (float& value : image.channels.back().floats()) value = random.unit();
  }
  image.channels.push_back({"primitive", Buffer<std::uint32_t>(count)});
  for (std::uint32_t& value : image.channels.back().integers()) value = random.next();
  return image;
}

/// Content of a file as OpenEXR reads it: 32 bits a value, unchanged.
struct Read {
  int width = 0, height = 0;
  std::vector<std::uint32_t> counts;
  std::map<std::string, std::vector<std::uint32_t>> values;  ///< by channel, sample after sample
  std::map<std::string, Imf::PixelType> types;
};

Read read_deep(const std::string& path) {
  Imf::DeepScanLineInputFile in(path.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  Read read;
  read.width = window.max.x + 1;
  read.height = window.max.y + 1;
  EXPECT_EQ(in.header().type(), Imf::DEEPSCANLINE);
  const std::size_t width = std::size_t(read.width), pixels = width * std::size_t(read.height);
  read.counts.resize(pixels);
  std::map<std::string, std::vector<char*>> pointers;
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(read.counts.data()), 4, 4 * width));
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    std::vector<char*>& places = pointers[c.name()];
    places.resize(pixels);
    read.types[c.name()] = c.channel().type;
    frame.insert(c.name(), Imf::DeepSlice(c.channel().type, reinterpret_cast<char*>(places.data()), sizeof(char*),
                                          sizeof(char*) * width, 4));
  }
  in.setFrameBuffer(frame);
  in.readPixelSampleCounts(0, read.height - 1);
  std::size_t total = 0;
  for (const std::uint32_t count : read.counts) total += count;
  for (auto& [name, places] : pointers) {
    std::vector<std::uint32_t>& values = read.values[name];
    values.resize(total + 1);
    std::size_t at = 0;
    for (std::size_t i = 0; i < pixels; at += read.counts[i++]) places[i] = reinterpret_cast<char*>(&values[at]);
  }
  in.readPixels(0, read.height - 1);
  return read;
}

std::vector<std::uint32_t> bits_of(const Channel& channel) {
  std::vector<std::uint32_t> bits(channel.is_integer() ? channel.integers().size() : channel.floats().size());
  const void* from = channel.is_integer() ? static_cast<const void*>(channel.integers().data())
                                          : static_cast<const void*>(channel.floats().data());
  std::memcpy(bits.data(), from, bits.size() * 4);
  return bits;
}

TEST(DeepExr, IsReadBackByOpenExr) {
  const ScratchFolder folder;
  const std::string path = folder.file("deep.exr");
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(37, 23), glm::ivec2(300, 5)}) {
    const DeepImage image = random_image(size.x, size.y, std::uint64_t(size.x));
    save(image, path);
    const Read read = read_deep(path);
    ASSERT_EQ(read.width, size.x);
    ASSERT_EQ(read.height, size.y);
    for (std::size_t i = 0; i < read.counts.size(); ++i) ASSERT_EQ(read.counts[i], image.first[i + 1] - image.first[i]);
    ASSERT_EQ(read.values.size(), image.channels.size());
    for (const Channel& channel : image.channels) {
      std::vector<std::uint32_t> values = read.values.at(channel.name);
      values.pop_back();  // the spare one
      EXPECT_EQ(values, bits_of(channel)) << channel.name;
      EXPECT_EQ(read.types.at(channel.name), channel.is_integer() ? Imf::UINT : Imf::FLOAT);
    }
  }
}

/// One channel of a deep file as OpenEXR flattens it: by its own sorting and compositing, for programs without support
/// of deep images.
std::vector<float> flattened_by_open_exr(const std::string& path, const char* channel) {
  Imf::InputFile in(path.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  const auto width = std::size_t(window.max.x) + 1, height = std::size_t(window.max.y) + 1;
  std::vector<float> values(width * height, -1.0f);
  Imf::FrameBuffer frame;
  frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * width));
  in.setFrameBuffer(frame);
  in.readPixels(0, window.max.y);
  return values;
}

TEST(DeepExr, IsFlattenedToThePictureByOpenExr) {
  const ScratchFolder folder;
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 128, 72);
  view.samples = 4;
  ShadeOptions options{.background = std::nullopt, .opacity = 0.4f, .light = {.shadows = Shadows::off}};
  const Visible visible = zbuffer(surfaces, view);
  const Image picture = shade(surfaces, visible, options);
  save(shade_deep(surfaces, visible, options), folder.file("deep.exr"));
  double worst = 0;
  for (const char* name : {"R", "G", "B", "A"}) {
    const std::vector<float> flat = flattened_by_open_exr(folder.file("deep.exr"), name);
    const auto expected = picture.find(name)->floats();
    for (std::size_t i = 0; i < flat.size(); ++i) worst = std::max(worst, double(std::abs(flat[i] - expected[i])));
  }
  EXPECT_LT(worst, 1e-5);
}

TEST(DeepExr, MayBeEmpty) {
  const ScratchFolder folder;
  DeepImage image{4, 3, Buffer<std::uint64_t>(13, std::uint64_t(0)), {}};
  image.channels.push_back({"Z", Buffer<float>()});
  save(image, folder.file("none.exr"));
  const Read read = read_deep(folder.file("none.exr"));
  EXPECT_EQ(read.counts, std::vector<std::uint32_t>(12, 0));
}

TEST(DeepExr, IsRefusedByReadersOfFlatImages) {
  const ScratchFolder folder;
  save(random_image(8, 8, 1), folder.file("deep.exr"));
  EXPECT_THROW((void)load_image(folder.file("deep.exr")), Error);
}

TEST(DeepExr, LeavesNothingWhenItCannotBeWritten) {
  const ScratchFolder folder;
  DeepImage image = random_image(8, 8, 2);
  image.channels[0].floats() = Buffer<float>(3);
  EXPECT_THROW(save(image, folder.file("deep.exr")), Error);
  EXPECT_THROW(save(random_image(8, 8, 2), folder.file("no/deep.exr")), Error);
  EXPECT_EQ(folder.entry_count(), 0u);
}

}  // namespace
}  // namespace frontmost::test
