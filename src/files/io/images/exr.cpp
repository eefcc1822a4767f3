// SPDX-License-Identifier: Apache-2.0
// OpenEXR files hold any channels by name: floats as 32-bit floats, and integers as uint32.
//
// The library has one pool of threads for the whole process, whose size only the program may set. So a picture is cut
// into strips of rows, and the library writes each strip as a file of its own, in parallel. The compressed rows of all
// strips are then joined behind one header. Deep images go row by row.
//
// Reading begins with a check of the sizes in the header, because the library allocates memory by them.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfPixelType.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <new>

#include "base/parallel.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

constexpr std::uint64_t most_exr_channels = 1024;
constexpr std::size_t exr_value_size = 4;

[[noreturn]] void fail_exr(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "EXR", reason);
}

/// Reads forward through a header, never past its end.
class ExrCursor {
 public:
  ExrCursor(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::span<const std::byte> take(std::size_t count) {
    if (count > bytes_.size()) fail_exr(name_, "the header is cut short");
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  std::int32_t number() {
    std::int32_t value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  /// Returns the text up to the next zero, and passes the zero.
  std::string_view text() {
    const auto end = std::find(bytes_.begin(), bytes_.end(), std::byte{0});
    const auto taken = take(std::size_t(end - bytes_.begin()));
    take(1);
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

struct ExrSizes {
  std::uint64_t width = 0, height = 0, channels = 0;
  unsigned compression = 0;  ///< as in the file: 0 none, 1 RLE, 2 and 3 ZIP, then wavelets and other things

  /// Returns the most bytes of memory that `bytes` bytes of a file may fill. Deflate makes at most 1032 bytes out of
  /// one. Other methods pack plain pictures without bound, so they may always fill some memory.
  [[nodiscard]] std::uint64_t most_memory(std::uint64_t bytes) const {
    constexpr std::uint64_t ratio = 1100, always = std::uint64_t(1) << 26;
    return compression <= 3 ? bytes * ratio : std::max(always, bytes * ratio);
  }
};

void read_window(ExrCursor window, ExrSizes& sizes) {
  // The numbers have 64 bits, because the difference of two 32-bit corners, plus one, does not fit into 32.
  const std::int64_t left = window.number(), top = window.number();
  const std::int64_t right = window.number(), bottom = window.number();
  sizes.width = std::uint64_t(std::max<std::int64_t>(0, right - left + 1));
  sizes.height = std::uint64_t(std::max<std::int64_t>(0, bottom - top + 1));
}

/// Adds the number of channels in a list to that of earlier lists, because the library also joins several lists.
void read_channels(ExrCursor list, ExrSizes& sizes, const std::string& name) {
  constexpr std::size_t record = 16;  // type, linearity and sampling
  for (; !list.text().empty(); ++sizes.channels) list.take(record);
  if (!list.at_end()) fail_exr(name, "the channel list ends before its attribute");
}

/// The library reads most attributes by their type and ignores the size that the file states. If size and type
/// disagree, the library would read other attributes than this check.
constexpr std::size_t any_size = ~std::size_t(0);
constexpr std::pair<std::string_view, std::size_t> attribute_sizes[] = {
    {"box2i", 16},        {"box2f", 16},   {"chlist", any_size}, {"chromaticities", 32},
    {"compression", 1},   {"double", 8},   {"envmap", 1},        {"float", 4},
    {"int", 4},           {"keycode", 28}, {"lineOrder", 1},     {"m33d", 72},
    {"m33f", 36},         {"m44d", 128},   {"m44f", 64},         {"rational", 8},
    {"string", any_size}, {"timecode", 8}, {"v2d", 16},          {"v2f", 8},
    {"v2i", 8},           {"v3d", 24},     {"v3f", 12},          {"v3i", 12},
};

void check_attribute(std::string_view type, std::size_t size, const std::string& name) {
  for (const auto& [known, its_size] : attribute_sizes) {
    if (type != known) continue;
    if (its_size != any_size && size != its_size)
      fail_exr(name, "an attribute's size does not fit its type " + std::string(type));
    return;
  }
  throw Error(ErrorCode::unsupported, name, "EXR", "attributes of type " + std::string(type) + " are not read");
}

ExrSizes read_sizes(ExrCursor header, const std::string& name) {
  ExrSizes sizes;
  for (std::string_view key = header.text(); !key.empty(); key = header.text()) {
    const std::string_view type = header.text();
    const std::int32_t size = header.number();
    if (size < 0) fail_exr(name, "attribute " + std::string(key) + " has a negative size");
    check_attribute(type, std::size_t(size), name);
    ExrCursor value(header.take(std::size_t(size)), name);
    if (key == "dataWindow") read_window(value, sizes);
    if (type == "chlist") read_channels(value, sizes, name);
    if (key == "compression") sizes.compression = std::to_integer<unsigned>(value.take(1)[0]);
  }
  return sizes;
}

/// \throws Error file_malformed, limit_exceeded, or unsupported for tiled, deep and multi-part files.
void check_exr_header(std::span<const std::byte> bytes, const std::string& name) {
  ExrCursor cursor(bytes, name);
  cursor.number();  // the signature
  const auto version = std::uint32_t(cursor.number());
  constexpr std::uint32_t tiled = 0x200, deep = 0x800, multi_part = 0x1000;
  if (version & (tiled | deep | multi_part))
    throw Error(ErrorCode::unsupported, name, "EXR", "tiled, deep and multi-part files are not read");
  const ExrSizes sizes = read_sizes(cursor, name);
  if (sizes.channels < 1 || sizes.channels > most_exr_channels)
    throw Error(ErrorCode::limit_exceeded, name, "EXR",
                std::to_string(sizes.channels) + " channels; expected 1 to 1024");
  check_image_size(name, sizes.width, sizes.height, bytes.size(), std::numeric_limits<double>::infinity(), "EXR");
  if (sizes.width * sizes.height * sizes.channels * 4 > sizes.most_memory(bytes.size()))
    fail_exr(name, std::to_string(bytes.size()) + " bytes cannot hold " + std::to_string(sizes.width) + " x " +
                       std::to_string(sizes.height) + " pixels of " + std::to_string(sizes.channels) + " channels");
}

/// A file in memory. The library goes back to fill in its table of offsets, which standard output does not allow.
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
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t place_ = 0;
};

/// Calls `work` and turns exceptions of OpenEXR into an Error that begins with the file's name.
template <class Work>
auto with_named_errors(const std::string& name, ErrorCode code, Work&& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(code, name, "EXR", error.what());
  }
}

Imf::PixelType type_of(const Channel& channel) { return channel.is_integer() ? Imf::UINT : Imf::FLOAT; }

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

/// Describes the planes of `image` to the library as memory to read from or write to, for a window whose first pixel is
/// (left, top).
Imf::FrameBuffer frame_buffer(Image& image, int left, int top) {
  const std::size_t stride = exr_value_size * std::size_t(image.width);
  Imf::FrameBuffer frame;
  for (Channel& channel : image.channels) {
    // The library expects the address of pixel (0, 0), which may lie outside the plane. The address is computed with
    // integers, because pointers must not leave the plane.
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(bytes_of(channel)) -
                                  std::uintptr_t(std::intptr_t(left)) * exr_value_size -
                                  std::uintptr_t(std::intptr_t(top)) * stride;
    frame.insert(channel.name, Imf::Slice(type_of(channel), reinterpret_cast<char*>(origin), exr_value_size, stride));
  }
  return frame;
}

/// Returns the rank of a channel in an image: colours come first, in their usual order. The file sorts channels by
/// name.
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

constexpr int chunk_rows = 16;  // rows of one ZIP chunk

/// A file with some rows of an image.
struct RowStrip {
  std::vector<std::byte> bytes;
  std::size_t start = 0;  ///< start of the compressed rows, behind the header and a table with one offset per chunk
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

/// One row of a deep image as the library expects it: the number of samples of each pixel, and for each channel their
/// addresses.
class DeepRow {
 public:
  explicit DeepRow(const DeepImage& image)
      : image_(image),
        counts_(std::size_t(image.width)),
        pointers_(image.channels.size(), std::vector<const char*>(std::size_t(image.width))) {}

  /// Returns a frame buffer for all rows: each row fills the same memory anew.
  [[nodiscard]] Imf::DeepFrameBuffer frame_buffer() {
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts_.data()), sizeof counts_[0], 0));
    for (std::size_t c = 0; c < pointers_.size(); ++c)
      frame.insert(image_.channels[c].name,
                   Imf::DeepSlice(type_of(image_.channels[c]), reinterpret_cast<char*>(pointers_[c].data()),
                                  sizeof(char*), 0, exr_value_size));
    return frame;
  }
  void fill(int y) {
    const std::size_t width = std::size_t(image_.width), row = std::size_t(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint64_t begin = image_.first[row + x];
      counts_[x] = std::uint32_t(image_.first[row + x + 1] - begin);
      for (std::size_t c = 0; c < pointers_.size(); ++c)
        pointers_[c][x] = reinterpret_cast<const char*>(bytes_of(image_.channels[c])) + begin * exr_value_size;
    }
  }

 private:
  const DeepImage& image_;
  std::vector<std::uint32_t> counts_;
  std::vector<std::vector<const char*>> pointers_;  ///< by channel
};

std::vector<std::byte> encode_deep(const DeepImage& image, const std::string& name, const Execution& execution) {
  Imf::Header header(image.width, image.height);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;  // the smallest files among the methods for deep data
  for (const Channel& channel : image.channels) header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  MemoryOutput memory(name);
  {
    DeepRow row(image);
    Imf::DeepScanLineOutputFile out(memory, header, 0);
    out.setFrameBuffer(row.frame_buffer());
    for (int y = 0; y < image.height; ++y) {
      check_cancelled(execution);
      row.fill(y);
      out.writePixels(1);
    }
  }
  return std::move(memory.bytes());
}

}  // namespace

void save_exr(const Image& image, OutputFile& file, const Execution& execution) {
  if (image.channels.size() > most_exr_channels)
    throw Error(ErrorCode::unsupported, file.name(), "EXR", "more than 1024 channels");
  constexpr int strip_rows = 4 * chunk_rows;
  auto& planes = const_cast<Image&>(image);  // the planes are only read
  std::vector<RowStrip> strips((std::size_t(image.height) + strip_rows - 1) / strip_rows);
  RowStrip head;
  with_named_errors(file.name(), ErrorCode::unsupported, [&] {
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

void save_deep_exr(const DeepImage& image, OutputFile& file, const Execution& execution) {
  with_named_errors(file.name(), ErrorCode::unsupported,
                    [&] { file.write(encode_deep(image, file.name(), execution)); });
}

Image load_exr(std::span<const std::byte> bytes, const std::string& name) {
  check_exr_header(bytes, name);
  return with_named_errors(name, ErrorCode::file_malformed, [&] {
    MemoryInput memory(bytes, name);
    Imf::InputFile in(memory, 0);
    const Imath::Box2i window = in.header().dataWindow();
    Image image = empty_image(in.header(), name);
    in.setFrameBuffer(frame_buffer(image, window.min.x, window.min.y));
    in.readPixels(window.min.y, window.max.y);
    return image;
  });
}

}  // namespace frontmost::detail
