// SPDX-License-Identifier: Apache-2.0
// Canvases for finished tiles: planes of linear floats, or bytes for screens without intermediate planes.

#include "shade/canvas/canvas.h"

#include <algorithm>
#include <cstring>

#include "image/srgb_pixels.h"

namespace frontmost::shading {
namespace {

constexpr int kBytes = 4;  ///< per pixel: R, G, B, A

/// One channel of a pixel, composited over the background.
float over(const glm::vec4& pixel, const glm::vec4& background, int k) {
  return pixel[k] + background[k] * (1.0f - pixel.a);
}

}  // namespace

void TileCanvas::write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                              const glm::vec4& background) {
  if (background.a < 1) return write(tile, pixels.colors, background);
  std::vector<glm::vec4> opaque = pixels.colors;
  for (std::size_t i = 0; i < opaque.size(); ++i)
    opaque[i] = glm::vec4(glm::vec3(opaque[i]) + glm::vec3(background) * (1.0f - pixels.alphas[i]), 1.0f);
  write(tile, opaque, background);
}

void store_rgba8(const glm::vec4& color, std::uint8_t* out) {
  store_srgb({color.r, color.g, color.b}, color.a, out);
  out[3] = rounded_fraction<std::uint8_t>(color.a);
}

PlanesCanvas::PlanesCanvas(const View& view, std::initializer_list<const char*> names, Image memory)
    : image_(std::move(memory)) {
  if (image_.width == view.width && image_.height == view.height && image_.channels.size() == names.size()) return;
  image_ = {view.width, view.height, {}};
  for (const char* name : names) image_.channels.push_back({name, Buffer<float>(view.pixel_count())});
}

std::size_t PlanesCanvas::row(const TileRectangle& tile, int y) const {
  return std::size_t(tile.y + y) * std::size_t(image_.width) + std::size_t(tile.x);
}

void PlanesCanvas::write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) {
  for (int k = 0; k < int(image_.channels.size()); ++k) {
    float* const plane = image_.channels[std::size_t(k)].floats().data();
    for (int y = 0; y < tile.height; ++y) {
      const glm::vec4* in = pixels.data() + y * tile.width;
      float* out = plane + row(tile, y);
      for (int x = 0; x < tile.width; ++x) out[x] = over(in[x], background, k);
    }
  }
}

void PlanesCanvas::fill(const TileRectangle& tile, const glm::vec4& value) {
  for (int k = 0; k < int(image_.channels.size()); ++k)
    for (int y = 0; y < tile.height; ++y)
      std::fill_n(image_.channels[std::size_t(k)].floats().data() + row(tile, y), tile.width, value[k]);
}

BitmapCanvas::BitmapCanvas(const View& view, Bitmap memory, Isa isa) : bitmap_(std::move(memory)), isa_(isa) {
  if (bitmap_.width == view.width && bitmap_.height == view.height && !bitmap_.rgba.empty()) return;
  bitmap_ = {view.width, view.height, Buffer<std::uint8_t>(kBytes * view.pixel_count())};
}

std::uint8_t* BitmapCanvas::row(const TileRectangle& tile, int y) {
  return bitmap_.rgba.data() + kBytes * (std::size_t(tile.y + y) * std::size_t(bitmap_.width) + std::size_t(tile.x));
}

void BitmapCanvas::write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) {
  for (int y = 0; y < tile.height; ++y)
    store_row(pixels.data() + y * tile.width, tile.width, background, row(tile, y), isa_);
}

void BitmapCanvas::fill(const TileRectangle& tile, const glm::vec4& value) {
  std::uint8_t pixel[kBytes];
  store_rgba8(value, pixel);
  for (int y = 0; y < tile.height; ++y) {
    std::uint8_t* out = row(tile, y);
    for (int x = 0; x < tile.width; ++x) std::memcpy(out + kBytes * x, pixel, kBytes);
  }
}

}  // namespace frontmost::shading
