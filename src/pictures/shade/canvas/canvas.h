// SPDX-License-Identifier: Apache-2.0
// Finished tiles are painted on canvases. One holds planes of linear floats, and one holds bytes for screens. Others
// change the tiles and pass them on to another canvas.
//
// Viewers of vector figures blend sRGB values. To do the same, colours are converted to sRGB before they are
// composited, and back when a pixel is done. The steps in between need no change.
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

/// A surface for finished tiles. Threads may paint different tiles at once.
class TileCanvas {
 public:
  virtual ~TileCanvas() = default;
  /// Composites the `pixels` of the tile, row by row and premultiplied, over the background.
  virtual void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) = 0;
  virtual void fill(const TileRectangle& tile, const glm::vec4& value) = 0;
  /// Writes pixels that have an alpha for each channel, and so tint what is behind them. A background that is not
  /// opaque is not tinted, because a picture has a single alpha.
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

/// A canvas that is an image of up to four channels with the given names.
class PlanesCanvas final : public TileCanvas {
 public:
  /// Reuses the image `memory` if it has the right size.
  PlanesCanvas(const View& view, std::initializer_list<const char*> names, Image memory = {});
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  [[nodiscard]] Image take() { return std::move(image_); }

 private:
  /// Returns the index in a plane of the first value of row y of the tile.
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

/// Composites every tile over the environment, and passes the tile to another canvas, which is borrowed. The
/// environment gets the exposure and tone mapping of the surfaces.
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

  /// Passes on the tile, with over(i, environment behind pixel i) for each pixel i.
  template <class Over>
  void paint(const TileRectangle& tile, const glm::vec4& background, const Over& over);
  /// Returns the radiance of the environment behind the middle of a pixel.
  [[nodiscard]] glm::vec3 radiance(int x, int y) const;

  TileCanvas& canvas_;
  ScreenRays rays_;
  Lighting lighting_;
  Isa isa_;
  Pool<Work> works_;
};

/// Receives premultiplied sRGB pixels over an sRGB background. Paints them in linear light on another canvas, which is
/// borrowed.
class LinearCanvas final : public TileCanvas {
 public:
  explicit LinearCanvas(TileCanvas& canvas) : canvas_(canvas) {}
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;

 private:
  TileCanvas& canvas_;
};

/// Stores one premultiplied linear pixel as four bytes R, G, B, A, which are sRGB and not premultiplied.
void store_rgba8(const glm::vec4& color, std::uint8_t* out);
/// Stores `count` pixels like store_rgba8(), composited over a background.
void store_row(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out, Isa isa);

/// Returns a colorist that converts the colours of `linear` to sRGB. Borrows `linear`.
[[nodiscard]] FragmentShader::Colorist srgb_colorist(const FragmentShader::Colorist& linear);

}  // namespace frontmost::shading
