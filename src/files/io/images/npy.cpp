// SPDX-License-Identifier: Apache-2.0
// NumPy arrays: a Python dictionary with type, order and shape, followed by the raw numbers.
#include <charconv>
#include <cstring>
#include <string_view>
#include <vector>

#include "io/images/formats.h"
#include "io/images/raw_planes.h"

namespace frontmost::detail {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view magic = "\x93NUMPY"sv;
constexpr std::size_t prefix_size = 10;  // magic, version, length of the dictionary
// Alignment of the numbers that NumPy itself uses since version 1.14, so that files can be mapped.
constexpr std::size_t alignment = 64;

[[noreturn]] void fail_npy(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "NPY", reason);
}

std::string shape_of(const Image& image) {
  std::string shape = std::to_string(image.height) + ", " + std::to_string(image.width);
  if (image.channels.size() > 1) shape += ", " + std::to_string(image.channels.size());
  return shape;
}

/// The dictionary's text, and its end, at which the numbers begin.
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

/// The text behind `key` and a colon in the dictionary. NumPy always writes keys in single quotes.
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

}  // namespace frontmost::detail
