// SPDX-License-Identifier: Apache-2.0
// The colours of an image in the form of screens and PNG: sRGB, straight alpha.
#pragma once

#include <limits>
#include <optional>

#include "base/srgb.h"
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

/// The planes R, G, B and, if there is one, A. None if one of R, G, B is missing or holds integers.
[[nodiscard]] std::optional<ColorPlanes> color_planes(const Image& image);

/// A fraction from 0 to 1 as an integer from 0 to the greatest Value, rounded. Values out of range are clamped, NaN
/// gives 0.
template <class Value>
[[nodiscard]] Value rounded_fraction(float fraction) {
  constexpr float most = float(std::numeric_limits<Value>::max());
  const float above = fraction > 0 ? fraction : 0.0f;  // false for NaN
  return Value(double(above < 1 ? above : 1.0f) * most + 0.5);
}

/// Writes the premultiplied colour of one pixel as sRGB for straight alpha; black if alpha is 0.
template <class Value>
void store_srgb(const float (&color)[3], float alpha, Value* out) {
  const auto value = [](float linear) {
    if constexpr (sizeof(Value) == 1) return srgb8_of_linear(linear);
    if constexpr (sizeof(Value) == 2) return srgb16_of_linear(linear);
  };
  if (alpha >= 1.0f) {
    for (int k = 0; k < 3; ++k) out[k] = value(color[k]);
  } else if (alpha > 0.0f) {
    for (int k = 0; k < 3; ++k) out[k] = value(color[k] / alpha);
  } else {
    out[0] = out[1] = out[2] = 0;
  }
}

/// Writes row y as bytes R, G, B, or R, G, B, A. Values out of range are clamped, NaN gives 0, and pixels with alpha 0
/// are black.
void srgb8_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint8_t* row);
/// Like srgb8_row(), with 16 bits a value.
void srgb16_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint16_t* row);

}  // namespace frontmost
