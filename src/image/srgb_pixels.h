// SPDX-License-Identifier: Apache-2.0
// The colours of an image as screens and PNG want them: sRGB, straight alpha.
#pragma once

#include <optional>

#include "frontmost/image.h"

namespace frontmost {

/// The colour planes of an image: linear, premultiplied by alpha.
struct ColorPlanes {
  int width = 0, height = 0;
  const float* color[3] = {};
  const float* alpha = nullptr;  ///< null: opaque

  /// Whether every pixel's alpha is 1 when rounded to 8 bits. O(pixels).
  [[nodiscard]] bool is_opaque() const;
};

/// R, G, B and, where there is one, A. None where one of the three is missing or holds integers.
[[nodiscard]] std::optional<ColorPlanes> color_planes(const Image& image);

/// Row y as bytes R, G, B, or R, G, B, A. Values out of range are clamped, NaN gives 0, and the colour of pixels with
/// alpha 0 is black.
void srgb8_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint8_t* row);
/// The same in 16 bits.
void srgb16_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint16_t* row);

}  // namespace frontmost
