// SPDX-License-Identifier: Apache-2.0
#include "image/srgb_pixels.h"

#include <cmath>

#include "base/srgb.h"

namespace frontmost {
namespace {

struct EightBits {
  using Value = std::uint8_t;
  static Value color(float linear) { return srgb8_of_linear(linear); }
};

struct SixteenBits {
  using Value = std::uint16_t;
  static Value color(float linear) { return srgb16_of_linear(linear); }
};

template <class Value>
Value rounded(float fraction) {
  constexpr float most = float(std::numeric_limits<Value>::max());
  const float above = fraction > 0 ? fraction : 0.0f;  // false for NaN
  return Value(double(above < 1 ? above : 1.0f) * most + 0.5);
}

template <class Bits>
void row_of(const ColorPlanes& planes, int y, bool with_alpha, typename Bits::Value* out) {
  using Value = typename Bits::Value;
  const std::size_t first = std::size_t(y) * std::size_t(planes.width);
  const float *r = planes.color[0] + first, *g = planes.color[1] + first, *b = planes.color[2] + first;
  const float* a = planes.alpha ? planes.alpha + first : nullptr;
  for (int x = 0; x < planes.width; ++x) {
    const float alpha = a ? a[x] : 1.0f;
    if (alpha >= 1.0f) {
      out[0] = Bits::color(r[x]);
      out[1] = Bits::color(g[x]);
      out[2] = Bits::color(b[x]);
    } else if (alpha > 0.0f) {
      out[0] = Bits::color(r[x] / alpha);
      out[1] = Bits::color(g[x] / alpha);
      out[2] = Bits::color(b[x] / alpha);
    } else {
      out[0] = out[1] = out[2] = 0;
    }
    out += 3;
    if (with_alpha) *out++ = rounded<Value>(alpha);
  }
}

const float* plane(const Image& image, std::string_view name) {
  const Channel* channel = image.find(name);
  return channel && !channel->is_integer() ? channel->floats().data() : nullptr;
}

}  // namespace

bool ColorPlanes::is_opaque() const {
  if (!alpha) return true;
  const std::size_t count = std::size_t(width) * std::size_t(height);
  // Block by block without branches, so that the compiler can go many pixels at a time.
  constexpr std::size_t block = 4096;
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t end = std::min(count, first + block);
    unsigned clear = 0;
    for (std::size_t i = first; i < end; ++i) clear |= unsigned(!(alpha[i] >= 254.5f / 255));
    if (clear) return false;
  }
  return true;
}

std::optional<ColorPlanes> color_planes(const Image& image) {
  ColorPlanes planes{
      image.width, image.height, {plane(image, "R"), plane(image, "G"), plane(image, "B")}, plane(image, "A")};
  for (const float* color : planes.color)
    if (!color) return std::nullopt;
  return planes;
}

void srgb8_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint8_t* row) {
  row_of<EightBits>(planes, y, with_alpha, row);
}

void srgb16_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint16_t* row) {
  row_of<SixteenBits>(planes, y, with_alpha, row);
}

}  // namespace frontmost
