// SPDX-License-Identifier: Apache-2.0
// Pictures as rows of 8-bit pixels for image formats, made from planes of floats or from bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "frontmost/image.h"

namespace frontmost::detail {

/// Rows of sRGB bytes with straight alpha: R, G, B or R, G, B, A. Borrows the picture that it was made from.
struct PictureRows {
  int width = 0, height = 0;
  bool with_alpha = false;  ///< whether any pixel is not opaque
  /// Fills row y, from the top. May be called from many threads at once.
  std::function<void(int y, std::uint8_t* row)> row;

  [[nodiscard]] std::size_t pixel_bytes() const { return with_alpha ? 4 : 3; }
  [[nodiscard]] std::size_t row_bytes() const { return pixel_bytes() * std::size_t(width); }
};

/// Empty unless the channels are R, G, B, or R, G, B, A, of floats. O(pixels), to look for alpha.
[[nodiscard]] std::optional<PictureRows> picture_rows(const Image& image);
[[nodiscard]] PictureRows picture_rows(const Bitmap& bitmap);

}  // namespace frontmost::detail
