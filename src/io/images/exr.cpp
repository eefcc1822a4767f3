// SPDX-License-Identifier: Apache-2.0
// OpenEXR: any channels by name, floats as 32-bit float, integers as uint32, ZIP compression.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "io/images/exr_header.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

/// A file in memory: the library goes back to fill in its table of offsets, which standard output could not.
class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(const std::string& name) : Imf::OStream(name.c_str()) {}

  void write(const char bytes[], int count) override {
    const std::size_t end = place_ + std::size_t(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + place_, bytes, std::size_t(count));
    place_ = end;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = std::size_t(place); }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t place_ = 0;
};

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}

  bool read(char out[], int count) override {
    if (count < 0 || place_ > bytes_.size() || std::size_t(count) > bytes_.size() - place_)
      throw std::runtime_error("ends too early");
    std::memcpy(out, bytes_.data() + place_, std::size_t(count));
    place_ += std::size_t(count);
    return place_ < bytes_.size();
  }
  std::uint64_t tellg() override { return place_; }
  void seekg(std::uint64_t place) override { place_ = std::size_t(place); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t place_ = 0;
};

Imf::PixelType type_of(const Channel& channel) { return channel.is_integer() ? Imf::UINT : Imf::FLOAT; }

char* plane_of(Channel& channel) {
  return channel.is_integer() ? reinterpret_cast<char*>(channel.integers().data())
                              : reinterpret_cast<char*>(channel.floats().data());
}

/// The planes of `image` as places to read from and write to, for a window whose first pixel is (left, top).
Imf::FrameBuffer frame_buffer(Image& image, int left, int top) {
  constexpr std::size_t size = 4;
  const std::size_t stride = size * std::size_t(image.width);
  Imf::FrameBuffer frame;
  for (Channel& channel : image.channels) {
    // The library wants to know where pixel (0, 0) would be, which may well lie outside of the plane: reckoned with
    // integers, as pointers must not go there.
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(plane_of(channel)) -
                                  std::uintptr_t(std::intptr_t(left)) * size -
                                  std::uintptr_t(std::intptr_t(top)) * stride;
    frame.insert(channel.name, Imf::Slice(type_of(channel), reinterpret_cast<char*>(origin), size, stride));
  }
  return frame;
}

/// Colours first and in their usual order; the file has all channels by alphabet.
int rank(const std::string& channel) {
  constexpr std::string_view first[] = {"R", "G", "B", "A"};
  return int(std::find(std::begin(first), std::end(first), channel) - std::begin(first));
}

Image empty_image(const Imf::Header& header, const std::string& name) {
  const Imath::Box2i& window = header.dataWindow();
  Image image{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
  const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
      throw Error(ErrorCode::unsupported, name + ": EXR: channel " + channel.name() + " is subsampled");
    if (channel.channel().type == Imf::UINT)
      image.channels.push_back({channel.name(), Buffer<std::uint32_t>(count, 0u)});
    else
      image.channels.push_back({channel.name(), Buffer<float>(count, 0.0f)});
  }
  std::stable_sort(image.channels.begin(), image.channels.end(),
                   [](const Channel& a, const Channel& b) { return rank(a.name) < rank(b.name); });
  return image;
}

}  // namespace

void save_exr(const Image& image, OutputFile& file) {
  constexpr int most_channels = 1024;  // as many as load_image() takes
  if (image.channels.size() > most_channels)
    throw Error(ErrorCode::unsupported, file.name() + ": EXR: more than 1024 channels");
  MemoryOutput memory(file.name());
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Channel& channel : image.channels)
      header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
    Imf::OutputFile out(memory, header, 0);
    out.setFrameBuffer(frame_buffer(const_cast<Image&>(image), 0, 0));  // which is only read
    out.writePixels(image.height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::unsupported, file.name() + ": EXR: " + error.what());
  }
  file.write(memory.bytes());
}

Image load_exr(std::span<const std::byte> bytes, const std::string& name) {
  check_exr_header(bytes, name);
  try {
    MemoryInput memory(bytes, name);
    Imf::InputFile in(memory, 0);
    const Imath::Box2i window = in.header().dataWindow();
    Image image = empty_image(in.header(), name);
    in.setFrameBuffer(frame_buffer(image, window.min.x, window.min.y));
    in.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::file_malformed, name + ": EXR: " + error.what());
  }
}

}  // namespace frontmost::detail
