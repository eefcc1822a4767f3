// SPDX-License-Identifier: Apache-2.0
// PNG files from rows of bytes, compressed in parallel.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "frontmost/base.h"

namespace frontmost::detail {

/// Contents of a PNG file. `row` may be called from many threads at once, and more than once for a row.
struct PngContents {
  enum class Color : std::uint8_t { grey = 0, rgb = 2, rgba = 6 };  ///< values of the file's header
  struct Text {
    std::string keyword, text;
  };
  int width = 0, height = 0;
  Color color = Color::rgb;
  int bits = 8;         ///< 8 or 16, big-endian
  bool is_srgb = true;  ///< whether the file is marked as sRGB
  std::vector<Text> texts;
  std::function<void(int y, std::uint8_t* row)> row;

  [[nodiscard]] std::size_t pixel_bytes() const;
};

/// Writes the whole file. The bytes do not depend on the number of threads.
void write_png(const PngContents& contents, OutputFile& file, const Execution& execution);

}  // namespace frontmost::detail
