// SPDX-License-Identifier: Apache-2.0
// Canvases for finished tiles: planes of floats, or bytes for display.
#pragma once

#include <initializer_list>
#include <vector>

#include "abuffer/fragment_pass.h"
#include "frontmost/image.h"
#include "shade/tile.h"

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
  float opacity = 1;     ///< of all surfaces, unless the A-buffer applies it
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

/// Stores one premultiplied pixel as four bytes R, G, B, A: sRGB, not premultiplied.
void store_rgba8(const glm::vec4& color, std::uint8_t* out);
/// Stores `count` pixels like store_rgba8(), composited over a background.
void store_row(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out, Isa isa);

}  // namespace frontmost::shading
