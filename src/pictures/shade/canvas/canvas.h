// SPDX-License-Identifier: Apache-2.0
// What finished tiles are painted on: planes of floats, or bytes as they are shown.
#pragma once

#include <initializer_list>
#include <vector>

#include "abuffer/fragment_pass.h"
#include "frontmost/image.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Different tiles may be painted from different threads at once.
class TileCanvas {
 public:
  virtual ~TileCanvas() = default;
  /// `pixels` of the tile, row by row, premultiplied, are laid over the background.
  virtual void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) = 0;
  virtual void fill(const TileRectangle& tile, const glm::vec4& value) = 0;
  /// Pixels with an alpha for each channel, through which what is behind is seen tinted. A background that is not
  /// opaque stays without tint: a picture has one alpha.
  virtual void write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                            const glm::vec4& background);
};

/// How a picture is made of what is seen.
struct Painting {
  TileCanvas& canvas;
  const FragmentShader::Colorist& colorist;
  glm::vec4 background;  ///< what an empty pixel gets
  float opacity = 1;     ///< of everything, where it is not the A-buffer's
  ShadingRate rate = ShadingRate::each_pixel;
};

/// An image of up to four channels, named as they are to be.
class PlanesCanvas final : public TileCanvas {
 public:
  /// `memory` is that of the image, where it fits.
  PlanesCanvas(const View& view, std::initializer_list<const char*> names, Image memory = {});
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  [[nodiscard]] Image take() { return std::move(image_); }

 private:
  /// Where row y of the tile begins in a plane.
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

/// One premultiplied pixel as four bytes R, G, B, A: sRGB, straight alpha.
void store_rgba8(const glm::vec4& color, std::uint8_t* out);
/// The same of `count` pixels laid over a background.
void store_row(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out, Isa isa);

}  // namespace frontmost::shading
