// SPDX-License-Identifier: Apache-2.0
// Rows of pixels in the form of PNG: sRGB, straight alpha, whole numbers.

#include "image/srgb_pixels.h"

#include <algorithm>

namespace frontmost {
namespace {

template <class Value>
void row_of(const ColorPlanes& planes, int y, bool with_alpha, Value* out) {
  const std::size_t first = std::size_t(y) * std::size_t(planes.width);
  const float *r = planes.color[0] + first, *g = planes.color[1] + first, *b = planes.color[2] + first;
  const float* a = planes.alpha ? planes.alpha + first : nullptr;
  for (int x = 0; x < planes.width; ++x) {
    const float alpha = a ? a[x] : 1.0f;
    store_srgb({r[x], g[x], b[x]}, alpha, out);
    out += 3;
    if (with_alpha) *out++ = rounded_fraction<Value>(alpha);
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
  // The loop goes block by block without branches, so that the compiler can use vectors.
  constexpr std::size_t block = 4096;
  constexpr float most_clear = 254.5f / 255;  // just below the quotient: the last float that rounds to 254
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t end = std::min(count, first + block);
    unsigned clear = 0;
    for (std::size_t i = first; i < end; ++i) clear |= unsigned(!(alpha[i] > most_clear));
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
  row_of(planes, y, with_alpha, row);
}

void srgb16_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint16_t* row) {
  row_of(planes, y, with_alpha, row);
}

Bitmap bitmap_of(const Image& image) {
  validate(image);
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (!planes) throw Error(ErrorCode::bad_argument, "image", "has no channels R, G and B of floats");
  Bitmap bitmap{image.width, image.height,
                Buffer<std::uint8_t>(4 * std::size_t(image.width) * std::size_t(image.height))};
  for (int y = 0; y < image.height; ++y)
    srgb8_row(*planes, y, true, bitmap.rgba.data() + 4 * std::size_t(y) * std::size_t(image.width));
  return bitmap;
}

float linear_of_srgb(std::uint8_t srgb) { return linear_of_srgb8(srgb); }

}  // namespace frontmost
