// SPDX-License-Identifier: Apache-2.0
#include "shade/canvas/canvas.h"

#include <algorithm>
#include <cstring>

#include "base/srgb.h"
#include "image/srgb_pixels.h"
#include "shade/colorists.h"

namespace frontmost::shading {
namespace {

constexpr int kBytes = 4;  ///< per pixel: R, G, B, A

/// Returns one channel of a pixel that is composited over the background.
float over(const glm::vec4& pixel, const glm::vec4& background, int k) {
  return pixel[k] + background[k] * (1.0f - pixel.a);
}

float srgb_of(float linear) { return float(srgb_of_linear(double(linear > 0 ? (linear < 1 ? linear : 1.0f) : 0.0f))); }

/// Returns the linear form of a premultiplied sRGB pixel. The sRGB curve is not linear, so the pixel is divided by its
/// alpha before it is converted, and multiplied by it afterwards. A clear pixel stays clear.
glm::vec4 linear_of_premultiplied(const glm::vec4& color) {
  if (!(color.a > 0)) return glm::vec4(0);
  return {linear_of_shown(glm::vec3(color) / color.a) * color.a, color.a};
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
  std::uint8_t* const first = row(tile, 0);
  for (int x = 0; x < tile.width; ++x) std::memcpy(first + kBytes * x, pixel, kBytes);
  for (int y = 1; y < tile.height; ++y) std::memcpy(row(tile, y), first, std::size_t(kBytes * tile.width));
}

glm::vec3 EnvironmentCanvas::radiance(int x, int y) const {
  const PrefilteredEnvironment* const environment = lighting_.around.environment;
  if (!environment) return glm::vec3(0);
  const glm::dvec3 ray = rays_.is_parallel() ? rays_.forward() : rays_.at(x + 0.5, y + 0.5);
  const glm::vec3 towards = glm::vec3(glm::normalize(ray)) * lighting_.around.world_from_environment;
  if (environment->picture.channels.empty()) return environment->levels[0].color(towards);
  return equirectangular_color(environment->picture, towards);
}

template <class Over>
void EnvironmentCanvas::paint(const TileRectangle& tile, const glm::vec4& background, const Over& over) {
  const auto work = works_.borrow([] { return std::make_unique<Work>(); });
  const int count = tile.width * tile.height;
  work->pixels.resize(std::size_t(count));
  FragmentBatch& batch = work->batch;
  for (int begin = 0; begin < count; begin += batch_capacity) {
    batch.coverage.count = std::min(batch_capacity, count - begin);
    for (int i = 0; i < batch.coverage.count; ++i) {
      const int pixel = begin + i;
      batch.light.set(i, radiance(tile.x + pixel % tile.width, tile.y + pixel / tile.width));
      batch.material.unlit[i] = 0;
    }
    finish_light(lighting_, batch, isa_);
    for (int i = 0; i < batch.coverage.count; ++i) {
      const auto pixel = std::size_t(begin + i);
      work->pixels[pixel] = over(pixel, batch.light.at(i));
    }
  }
  canvas_.write(tile, work->pixels, background);
}

void EnvironmentCanvas::write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels,
                              const glm::vec4& background) {
  paint(tile, background, [&](std::size_t i, const glm::vec3& behind) {
    return pixels[i] + glm::vec4(behind, 1.0f) * (1.0f - pixels[i].a);
  });
}

void EnvironmentCanvas::write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                                     const glm::vec4& background) {
  paint(tile, background, [&](std::size_t i, const glm::vec3& behind) {
    return glm::vec4(glm::vec3(pixels.colors[i]) + behind * (1.0f - pixels.alphas[i]), 1.0f);
  });
}

void EnvironmentCanvas::fill(const TileRectangle& tile, const glm::vec4& value) {
  paint(tile, value, [](std::size_t, const glm::vec3& behind) { return glm::vec4(behind, 1.0f); });
}

void LinearCanvas::write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) {
  std::vector<glm::vec4> turned;
  turned.reserve(pixels.size());
  for (const glm::vec4& pixel : pixels)
    turned.push_back(linear_of_premultiplied(pixel + background * (1.0f - pixel.a)));
  canvas_.write(tile, turned, glm::vec4(0));
}

void LinearCanvas::fill(const TileRectangle& tile, const glm::vec4& value) {
  canvas_.fill(tile, linear_of_premultiplied(value));
}

FragmentShader::Colorist srgb_colorist(const FragmentShader::Colorist& linear) {
  return [&linear](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
    linear(setups, batch);
    if (batch.layers.has_transmission) hide_by_highlights(batch);
    for (int i = 0; i < batch.coverage.count; ++i) {
      const glm::vec3 light = batch.light.at(i);
      batch.light.set(i, {srgb_of(light.x), srgb_of(light.y), srgb_of(light.z)});
    }
  };
}

}  // namespace frontmost::shading
