// SPDX-License-Identifier: Apache-2.0
// What PFM and NPY share: both are a short text header and raw numbers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "base/output_file.h"
#include "frontmost/image.h"

namespace frontmost::detail {

static_assert(std::endian::native == std::endian::little, "raw numbers are written and read as they lie in memory");

/// Which numbers a file holds, row by row, the channels of a pixel side by side.
struct RawLayout {
  std::size_t width = 0, height = 0, channels = 0;
  bool integers = false;
  bool bottom_row_first = false;
  bool big_endian = false;

  [[nodiscard]] std::size_t row_values() const { return width * channels; }
};

/// Writes all channels of `image`, which must be of one type.
void write_raw(const Image& image, const RawLayout& layout, OutputFile& file);

/// \throws Error file_malformed where `bytes` are not exactly what the layout asks for, limit_exceeded.
/// Channels are named by default_channel_names().
[[nodiscard]] Image read_raw(std::span<const std::byte> bytes, const RawLayout& layout, const std::string& name,
                             const char* format);

}  // namespace frontmost::detail
