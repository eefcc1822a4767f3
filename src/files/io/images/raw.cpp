// SPDX-License-Identifier: Apache-2.0
// NPY and PFM files have a short header, and then raw numbers row by row, with the channels of a pixel side by side.
//
// NumPy arrays have a Python dictionary with type, order and shape. Portable float maps have "PF" (three channels) or
// "Pf" (one), width and height, and a scale whose sign gives the byte order, each on a line of its own. The bottom row
// of a float map comes first.
#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

using namespace std::string_view_literals;

static_assert(std::endian::native == std::endian::little, "raw numbers are written and read as they lie in memory");

struct RawLayout {
  std::size_t width = 0, height = 0, channels = 0;
  bool integers = false;
  bool bottom_row_first = false;
  bool big_endian = false;

  [[nodiscard]] std::size_t row_values() const { return width * channels; }
};

constexpr std::size_t value_size = 4;

std::size_t image_row(const RawLayout& layout, std::size_t file_row) {
  return layout.bottom_row_first ? layout.height - 1 - file_row : file_row;
}

/// Writes all channels of `image`, which must be of one type.
void write_raw(const Image& image, const RawLayout& layout, OutputFile& file) {
  // Many rows are written at a time, so that small pictures take few system calls.
  constexpr std::size_t block_bytes = std::size_t(1) << 20;
  const std::size_t row_bytes = layout.row_values() * value_size;
  const std::size_t block_rows = std::clamp<std::size_t>(block_bytes / row_bytes, 1, layout.height);
  Buffer<std::byte> block(block_rows * row_bytes);
  for (std::size_t first = 0; first < layout.height; first += block_rows) {
    const std::size_t end = std::min(layout.height, first + block_rows);
    std::byte* out = block.data();
    for (std::size_t row = first; row < end; ++row)
      for (std::size_t x = 0; x < layout.width; ++x)
        for (const Channel& channel : image.channels) {
          const std::size_t index = image_row(layout, row) * layout.width + x;
          std::memcpy(out, bytes_of(channel) + index * value_size, value_size);
          out += value_size;
        }
    file.write({block.data(), (end - first) * row_bytes});
  }
}

/// Returns channel names for formats that store none: see load_image().
std::vector<std::string> default_channel_names(std::size_t count, bool integers) {
  if (count == 1) return {integers ? "primitive" : "Z"};
  if (count == 3 && !integers) return {"R", "G", "B"};
  if (count == 4 && !integers) return {"R", "G", "B", "A"};
  std::vector<std::string> names(count);
  for (std::size_t i = 0; i < count; ++i) names[i] = std::to_string(i);
  return names;
}

/// Reads the channels behind the header. \throws Error file_malformed if `bytes` does not have exactly the layout's
/// size; limit_exceeded.
Image read_raw(std::span<const std::byte> bytes, const RawLayout& layout, const std::string& name, const char* format) {
  constexpr std::size_t most_channels = 1024;
  if (layout.channels < 1 || layout.channels > most_channels)
    throw Error(ErrorCode::limit_exceeded, name, format,
                std::to_string(layout.channels) + " channels; expected 1 to 1024");
  // The density has no limit, because the exact number of bytes is checked below.
  check_image_size(name, layout.width, layout.height, bytes.size(), std::numeric_limits<double>::infinity(), format);
  const std::size_t expected = layout.height * layout.row_values() * value_size;
  // Too many bytes are as wrong as too few: a misread header would give a picture shifted by some bytes.
  if (bytes.size() != expected)
    throw Error(ErrorCode::file_malformed, name, format,
                "the header asks for " + std::to_string(expected) + " bytes of numbers, but " +
                    std::to_string(bytes.size()) + " follow");
  Image image{int(layout.width), int(layout.height), {}};
  for (std::string& channel : default_channel_names(layout.channels, layout.integers)) {
    const std::size_t count = layout.width * layout.height;
    if (layout.integers) image.channels.push_back({std::move(channel), Buffer<std::uint32_t>(count)});
    if (!layout.integers) image.channels.push_back({std::move(channel), Buffer<float>(count)});
  }
  const std::byte* in = bytes.data();
  for (std::size_t row = 0; row < layout.height; ++row)
    for (std::size_t x = 0; x < layout.width; ++x)
      for (Channel& channel : image.channels) {
        std::byte* value =
            const_cast<std::byte*>(bytes_of(channel)) + (image_row(layout, row) * layout.width + x) * value_size;
        std::memcpy(value, in, value_size);
        if (layout.big_endian) std::reverse(value, value + value_size);
        in += value_size;
      }
  return image;
}

constexpr std::string_view magic = "\x93NUMPY"sv;
constexpr std::size_t prefix_size = 10;  // magic, version, length of the dictionary
// The numbers are aligned as NumPy aligns them since version 1.14, so that files can be mapped.
constexpr std::size_t alignment = 64;

[[noreturn]] void fail_npy(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "NPY", reason);
}

std::string shape_of(const Image& image) {
  std::string shape = std::to_string(image.height) + ", " + std::to_string(image.width);
  if (image.channels.size() > 1) shape += ", " + std::to_string(image.channels.size());
  return shape;
}

/// The text of the dictionary, and the place in the file where it ends and the numbers begin.
struct Dictionary {
  std::string_view text;
  std::size_t end = 0;
};

Dictionary dictionary(std::span<const std::byte> bytes, const std::string& name) {
  const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  if (bytes.size() < prefix_size + 2) fail_npy(name, "the header is cut short");
  const std::size_t version = byte(6);
  // Version 3 differs from 2 only in UTF-8 names, which the arrays read here do not have.
  if (version < 1 || version > 3)
    throw Error(ErrorCode::unsupported, name, "NPY", "version " + std::to_string(version));
  // The length has four bytes from version 2 on.
  const std::size_t start = version == 1 ? prefix_size : prefix_size + 2;
  std::size_t length = byte(8) + (byte(9) << 8);
  if (version > 1) length += (byte(10) << 16) + (byte(11) << 24);
  if (length > bytes.size() - start) fail_npy(name, "the header is cut short");
  return {{reinterpret_cast<const char*>(bytes.data()) + start, length}, start + length};
}

/// Returns the text that follows `key` and a colon in the dictionary. NumPy always writes keys in single quotes.
std::string_view value_of(std::string_view text, std::string_view key, const std::string& name) {
  // This is no parser of Python: keys are found as NumPy writes them, and any other spelling is refused.
  const std::size_t place = text.find(key);
  const std::size_t colon = place == text.npos ? text.npos : text.find(':', place);
  const std::size_t value = colon == text.npos ? text.npos : text.find_first_not_of(' ', colon + 1);
  if (value == text.npos) fail_npy(name, "the header has no " + std::string(key));
  return text.substr(value);
}

std::vector<std::size_t> shape(std::string_view text, const std::string& name) {
  const std::size_t end = text.find(')');
  if (text[0] != '(' || end == text.npos) fail_npy(name, "the shape is not a tuple");
  std::vector<std::size_t> sizes;
  const char* place = text.data() + 1;
  const char* const stop = text.data() + end;
  while (place < stop) {
    std::uint32_t size = 0;
    const auto [rest, error] = std::from_chars(place, stop, size);
    if (error != std::errc() || sizes.size() == 3) fail_npy(name, "the shape is not (height, width[, channels])");
    sizes.push_back(size);
    place = rest;
    // A tuple of one number ends with a comma, and longer tuples may, too.
    while (place < stop && (*place == ',' || *place == ' ')) ++place;
  }
  if (sizes.size() < 2) fail_npy(name, "the shape is not (height, width[, channels])");
  return sizes;
}

[[noreturn]] void fail_pfm(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "PFM", reason);
}

/// Takes words off the front of the file. Exactly one blank ends each word, because pixels may look like blanks.
class PfmHeader {
 public:
  PfmHeader(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::string_view word() {
    // A file of another format may hold no blank for megabytes.
    constexpr std::size_t longest = 64;
    const auto* text = reinterpret_cast<const char*>(bytes_.data());
    std::size_t end = 0;
    while (end < bytes_.size() && end < longest && !std::isspace(static_cast<unsigned char>(text[end]))) ++end;
    if (end == 0 || end == bytes_.size() || end == longest) fail_pfm(name_, "the header is cut short");
    bytes_ = bytes_.subspan(end + 1);
    return {text, end};
  }

  std::size_t size() {
    const std::string_view text = word();
    std::uint32_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size()) fail_pfm(name_, "a size is not a number");
    return value;
  }

  [[nodiscard]] std::span<const std::byte> rest() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

}  // namespace

std::string npy_header(const std::string& type, const std::string& shape) {
  std::string text = "{'descr': " + type + ", 'fortran_order': False, 'shape': (" + shape + "), }";
  // Blanks and a line end fill the header up to the alignment.
  text.append((alignment - (prefix_size + text.size() + 1) % alignment) % alignment, ' ');
  text += '\n';
  std::string header(magic);
  header += {'\1', '\0', char(text.size() & 0xFF), char(text.size() >> 8)};
  return header + text;
}

void save_npy(const Image& image, OutputFile& file) {
  const bool integers = image.channels[0].is_integer();
  for (const Channel& channel : image.channels)
    if (channel.is_integer() != integers)
      throw Error(ErrorCode::unsupported, file.name(), "",
                  "NPY holds channels of one type, not a mixture: " + channel_list(image));
  const std::string header = npy_header(integers ? "'<u4'" : "'<f4'", shape_of(image));
  file.write(std::as_bytes(std::span(header)));
  write_raw(image, {std::size_t(image.width), std::size_t(image.height), image.channels.size(), integers}, file);
}

Image load_npy(std::span<const std::byte> bytes, const std::string& name) {
  const Dictionary header = dictionary(bytes, name);
  // Five characters include both quotes, so that longer names such as '<f16' do not pass for '<f1'.
  const std::string_view type = value_of(header.text, "'descr'", name).substr(0, 5);
  const bool floats = type == "'<f4'" || type == "'>f4'", integers = type == "'<u4'" || type == "'>u4'";
  if (!floats && !integers)
    throw Error(ErrorCode::unsupported, name, "NPY", "only float32 (f4) and uint32 (u4) arrays are read");
  if (value_of(header.text, "'fortran_order'", name).substr(0, 5) != "False")
    throw Error(ErrorCode::unsupported, name, "NPY", "arrays in Fortran order are not read");
  const std::vector<std::size_t> sizes = shape(value_of(header.text, "'shape'", name), name);
  RawLayout layout{sizes[1], sizes[0], sizes.size() == 3 ? sizes[2] : 1, integers};
  layout.big_endian = type[1] == '>';
  return read_raw(bytes.subspan(header.end), layout, name, "NPY");
}

void save_pfm(const Image& image, OutputFile& file) {
  const std::size_t channels = image.channels.size();
  bool floats = true;
  for (const Channel& channel : image.channels) floats = floats && !channel.is_integer();
  if (!floats || (channels != 1 && channels != 3))
    throw Error(ErrorCode::unsupported, file.name(), "",
                "PFM holds one or three channels of floats, not " + channel_list(image));
  const std::string header = std::string(channels == 1 ? "Pf\n" : "PF\n") + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  file.write(std::as_bytes(std::span(header)));
  RawLayout layout{std::size_t(image.width), std::size_t(image.height), channels};
  layout.bottom_row_first = true;
  write_raw(image, layout, file);
}

Image load_pfm(std::span<const std::byte> bytes, const std::string& name) {
  PfmHeader header(bytes, name);
  RawLayout layout;
  // Other programs have extended the format, for example PF4 with four channels. A prefix match would misread such
  // files.
  const std::string_view kind = header.word();
  if (kind != "PF" && kind != "Pf") fail_pfm(name, "neither PF nor Pf");
  layout.channels = kind == "PF" ? 3 : 1;
  layout.width = header.size();
  layout.height = header.size();
  const std::string_view scale = header.word();
  // A scale of 0 is refused: its sign cannot give the byte order, because 0 and -0 are one number.
  if (scale.find_first_of("123456789") == std::string_view::npos) fail_pfm(name, "the scale is not a number");
  layout.big_endian = scale[0] != '-';  // the scale's magnitude has no agreed meaning and is ignored
  layout.bottom_row_first = true;
  return read_raw(header.rest(), layout, name, "PFM");
}

}  // namespace frontmost::detail
