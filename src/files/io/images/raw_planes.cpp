// SPDX-License-Identifier: Apache-2.0
// Raw numbers of NPY and PFM files: pixel by pixel, the channels of a pixel side by side.

#include "io/images/raw_planes.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "io/images/decode.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

const std::byte* plane_bytes(const Channel& channel) {
  const void* data = channel.is_integer() ? static_cast<const void*>(channel.integers().data())
                                          : static_cast<const void*>(channel.floats().data());
  return static_cast<const std::byte*>(data);
}

std::byte* plane_bytes(Channel& channel) { return const_cast<std::byte*>(plane_bytes(std::as_const(channel))); }

constexpr std::size_t value_size = 4;

std::size_t image_row(const RawLayout& layout, std::size_t file_row) {
  return layout.bottom_row_first ? layout.height - 1 - file_row : file_row;
}

}  // namespace

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
          std::memcpy(out, plane_bytes(channel) + index * value_size, value_size);
          out += value_size;
        }
    file.write({block.data(), (end - first) * row_bytes});
  }
}

Image read_raw(std::span<const std::byte> bytes, const RawLayout& layout, const std::string& name, const char* format) {
  constexpr std::size_t most_channels = 1024;
  if (layout.channels < 1 || layout.channels > most_channels)
    throw Error(ErrorCode::limit_exceeded, name, format, std::to_string(layout.channels) + " channels, not 1 to 1024");
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
        std::byte* value = plane_bytes(channel) + (image_row(layout, row) * layout.width + x) * value_size;
        std::memcpy(value, in, value_size);
        if (layout.big_endian) std::reverse(value, value + value_size);
        in += value_size;
      }
  return image;
}

}  // namespace frontmost::detail
