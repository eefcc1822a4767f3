// SPDX-License-Identifier: Apache-2.0
#include "io/images/picture_rows.h"

#include <algorithm>

#include "image/srgb_pixels.h"

namespace frontmost::detail {

std::optional<PictureRows> picture_rows(const Image& image) {
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (!planes || image.channels.size() != (planes->alpha ? 4u : 3u)) return std::nullopt;
  const bool with_alpha = !planes->is_opaque();
  return PictureRows{image.width, image.height, with_alpha, [planes = *planes, with_alpha](int y, std::uint8_t* row) {
                       srgb8_row(planes, y, with_alpha, row);
                     }};
}

PictureRows picture_rows(const Bitmap& bitmap) {
  constexpr std::size_t bytes = 4;  // a pixel
  const std::size_t size = bitmap.rgba.size();
  std::uint8_t least = 255;
  // The loop has no branches and no early exit, which is faster than stopping at the first transparent pixel.
  for (std::size_t i = bytes - 1; i < size; i += bytes) least = std::min(least, bitmap.rgba[i]);
  const bool with_alpha = least < 255;
  return {bitmap.width, bitmap.height, with_alpha, [&bitmap, with_alpha](int y, std::uint8_t* row) {
            const std::size_t width = std::size_t(bitmap.width);
            const std::uint8_t* in = bitmap.rgba.data() + bytes * width * std::size_t(y);
            if (with_alpha) {
              std::copy_n(in, bytes * width, row);
            } else {
              for (std::size_t x = 0; x < width; ++x)
                for (std::size_t k = 0; k < 3; ++k) row[3 * x + k] = in[bytes * x + k];
            }
          }};
}

}  // namespace frontmost::detail
