// SPDX-License-Identifier: Apache-2.0
// Canvases, on which finished tiles are painted: planes of linear floats, bytes for screens without intermediate
// planes, and canvases that change tiles and pass them on to another one.
//
// Blending in sRGB values is like that of viewers of vector figures. Colours are converted to sRGB before they are
// composited, and back when a pixel is done, so the steps in between are unchanged.
//
//   colorist --linear--> srgb_colorist --sRGB--> samples, layers, background --sRGB--> LinearCanvas --linear--> canvas
#pragma once

#include <initializer_list>
#include <vector>

#include "abuffer/fragment_pass.h"
#include "base/pool.h"
#include "frontmost/image.h"
#include "shade/light/lighting.h"
#include "shade/tile.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// Threads may paint different tiles at once.
class TileCanvas {
 public:
  virtual ~TileCanvas() = default;
  /// Composites the `pixels` of the tile, row by row and premultiplied, over the background.
  virtual void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) = 0;
  virtual void fill(const TileRectangle& tile, const glm::vec4& value) = 0;
  /// Writes pixels with an alpha for each channel, which tint what is behind them. A background that is not opaque is
  /// not tinted, because a picture has a single alpha.
  virtual void write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                            const glm::vec4& background);
};

/// How visible fragments become a picture.
struct Painting {
  TileCanvas& canvas;
  const FragmentShader::Colorist& colorist;
  glm::vec4 background;  ///< value of an empty pixel
  float opacity = 1;     ///< factor of all opacities, unless the A-buffer applies it
  ShadingRate rate = ShadingRate::each_pixel;
};

/// An image of up to four channels with the given names.
class PlanesCanvas final : public TileCanvas {
 public:
  /// Reuses the image `memory` if it has the right size.
  PlanesCanvas(const View& view, std::initializer_list<const char*> names, Image memory = {});
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  [[nodiscard]] Image take() { return std::move(image_); }

 private:
  /// The index in a plane at which row y of the tile begins.
  [[nodiscard]] std::size_t row(const TileRectangle& tile, int y) const;
  Image image_;
};

class BitmapCanvas final : public TileCanvas {
 public:
  BitmapCanvas(const View& view, Bitmap memory, Isa isa);
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  [[nodiscard]] Bitmap take() { return std::move(bitmap_); }

 private:
  [[nodiscard]] std::uint8_t* row(const TileRectangle& tile, int y);
  Bitmap bitmap_;
  Isa isa_;
};

/// Composites every tile over the environment and passes the tile to another canvas, which it borrows. The environment
/// gets the same exposure and tone mapping as surfaces.
class EnvironmentCanvas final : public TileCanvas {
 public:
  EnvironmentCanvas(TileCanvas& canvas, const View& view, const Lighting& lighting, Isa isa)
      : canvas_(canvas), rays_(view), lighting_(lighting), isa_(isa) {}
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  void write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                    const glm::vec4& background) override;

 private:
  /// Used by one thread at a time.
  struct Work {
    FragmentBatch batch;
    std::vector<glm::vec4> pixels;
  };

  /// Paints over(i, environment behind pixel i) for each pixel i of the tile.
  template <class Over>
  void paint(const TileRectangle& tile, const glm::vec4& background, const Over& over);
  /// The radiance seen at the middle of a pixel.
  [[nodiscard]] glm::vec3 radiance(int x, int y) const;

  TileCanvas& canvas_;
  ScreenRays rays_;
  Lighting lighting_;
  Isa isa_;
  Pool<Work> works_;
};

/// Takes premultiplied sRGB pixels over a background in sRGB, and paints them in linear light on another canvas, which
/// it borrows.
class LinearCanvas final : public TileCanvas {
 public:
  explicit LinearCanvas(TileCanvas& canvas) : canvas_(canvas) {}
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;

 private:
  TileCanvas& canvas_;
};

/// Stores one premultiplied pixel as four bytes R, G, B, A: sRGB, not premultiplied.
void store_rgba8(const glm::vec4& color, std::uint8_t* out);
/// Stores `count` pixels like store_rgba8(), composited over a background.
void store_row(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out, Isa isa);

/// Colours like another colorist, which it borrows, but in sRGB.
[[nodiscard]] FragmentShader::Colorist srgb_colorist(const FragmentShader::Colorist& linear);

}  // namespace frontmost::shading
