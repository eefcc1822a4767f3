// SPDX-License-Identifier: Apache-2.0
// OpenEXR: any channels by name, floats as 32-bit float, integers as uint32, ZIP compression.
//
// The library has one pool of threads for the whole process, whose size only the program may set. So a picture is cut
// into strips of rows, and the library writes each strip as a file of its own, in parallel. The compressed rows of all
// strips are then joined behind one header.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "base/parallel.h"
#include "io/images/exr/header.h"
#include "io/images/exr/output.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

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

char* plane_of(Channel& channel) {
  return channel.is_integer() ? reinterpret_cast<char*>(channel.integers().data())
                              : reinterpret_cast<char*>(channel.floats().data());
}

/// The planes of `image` as memory to read from or write to, for a window whose first pixel is (left, top).
Imf::FrameBuffer frame_buffer(Image& image, int left, int top) {
  constexpr std::size_t size = 4;
  const std::size_t stride = size * std::size_t(image.width);
  Imf::FrameBuffer frame;
  for (Channel& channel : image.channels) {
    // The library expects the address of pixel (0, 0), which may lie outside the plane. The address is computed with
    // integers, because pointers must not leave the plane.
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(plane_of(channel)) -
                                  std::uintptr_t(std::intptr_t(left)) * size -
                                  std::uintptr_t(std::intptr_t(top)) * stride;
    frame.insert(channel.name, Imf::Slice(type_of(channel), reinterpret_cast<char*>(origin), size, stride));
  }
  return frame;
}

/// Order of channels: colours first and in their usual order. The file sorts all channels by name.
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
      throw Error(ErrorCode::unsupported, name, "EXR", std::string("channel ") + channel.name() + " is subsampled");
    if (channel.channel().type == Imf::UINT)
      image.channels.push_back({channel.name(), Buffer<std::uint32_t>(count, 0u)});
    else
      image.channels.push_back({channel.name(), Buffer<float>(count, 0.0f)});
  }
  std::stable_sort(image.channels.begin(), image.channels.end(),
                   [](const Channel& a, const Channel& b) { return rank(a.name) < rank(b.name); });
  return image;
}

constexpr int chunk_rows = 16;  // of one ZIP chunk

/// A file with some rows of an image.
struct RowStrip {
  std::vector<std::byte> bytes;
  std::size_t start = 0;  ///< start of the compressed rows, behind the header and a table with one offset a chunk
};

enum class Pixels : bool { left_out, written };

RowStrip make_strip(Image& image, int first, int end, Pixels pixels, const std::string& name) {
  Imf::Header header(image.width, image.height);
  header.dataWindow() = Imath::Box2i({0, first}, {image.width - 1, end - 1});
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;  // 18 % faster than the library's 4, and 4 % larger
  for (const Channel& channel : image.channels) header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  MemoryOutput memory(name);
  RowStrip strip;
  {
    Imf::OutputFile out(memory, header, 0);
    strip.start = std::size_t(memory.tellp());
    if (pixels == Pixels::written) {
      out.setFrameBuffer(frame_buffer(image, 0, 0));
      out.writePixels(end - first);
    }
  }
  strip.bytes = std::move(memory.bytes());
  return strip;
}

/// Fills in the table of offsets, which ends the header. Each chunk begins with its first row and its size.
void fill_in_offsets(RowStrip& head, const std::vector<RowStrip>& strips, int height) {
  const std::size_t count = (std::size_t(height) + chunk_rows - 1) / chunk_rows;
  std::byte* entry = head.bytes.data() + head.start - 8 * count;
  std::uint64_t place = head.start;
  for (const RowStrip& strip : strips)
    for (std::size_t at = strip.start; at < strip.bytes.size(); entry += 8) {
      std::memcpy(entry, &place, sizeof place);
      std::int32_t size;
      std::memcpy(&size, &strip.bytes[at + 4], sizeof size);
      at += 8 + std::size_t(size);
      place += 8 + std::size_t(size);
    }
}

}  // namespace

void save_exr(const Image& image, OutputFile& file, const Execution& execution) {
  constexpr int most_channels = 1024;  // as many as load_image() takes
  if (image.channels.size() > most_channels)
    throw Error(ErrorCode::unsupported, file.name(), "EXR", "more than 1024 channels");
  constexpr int strip_rows = 4 * chunk_rows;
  auto& planes = const_cast<Image&>(image);  // which are only read
  std::vector<RowStrip> strips((std::size_t(image.height) + strip_rows - 1) / strip_rows);
  RowStrip head;
  with_named_errors(file.name(), [&] {
    // A file of all rows without pixels has the header and the table of offsets of the whole file.
    head = make_strip(planes, 0, image.height, Pixels::left_out, file.name());
    parallel_for(execution, std::size_t(image.height), strip_rows, [&](std::size_t first, std::size_t end) {
      strips[first / strip_rows] = make_strip(planes, int(first), int(end), Pixels::written, file.name());
    });
  });
  fill_in_offsets(head, strips, image.height);
  file.write(std::span(head.bytes).first(head.start));
  for (const RowStrip& strip : strips) file.write(std::span(strip.bytes).subspan(strip.start));
}

Image load_exr(std::span<const std::byte> bytes, const std::string& name) {
  // The library allocates memory by the sizes in the header, before it checks whether the file has enough bytes.
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
    throw Error(ErrorCode::file_malformed, name, "EXR", error.what());
  }
}

}  // namespace frontmost::detail
