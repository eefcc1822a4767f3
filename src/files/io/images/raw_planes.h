// SPDX-License-Identifier: Apache-2.0
// Raw numbers that follow the short text header of a PFM or NPY file.
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

/// Layout of the numbers in a file: row by row, the channels of a pixel side by side.
struct RawLayout {
  std::size_t width = 0, height = 0, channels = 0;
  bool integers = false;
  bool bottom_row_first = false;
  bool big_endian = false;

  [[nodiscard]] std::size_t row_values() const { return width * channels; }
};

/// Writes all channels of `image`, which must be of one type.
void write_raw(const Image& image, const RawLayout& layout, OutputFile& file);

/// \throws Error file_malformed if `bytes` does not have exactly the layout's size; limit_exceeded.
/// default_channel_names() gives the names of the channels.
[[nodiscard]] Image read_raw(std::span<const std::byte> bytes, const RawLayout& layout, const std::string& name,
                             const char* format);

}  // namespace frontmost::detail
