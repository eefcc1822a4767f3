// SPDX-License-Identifier: Apache-2.0
// Blending in sRGB values, like viewers of vector figures. Colours are converted to sRGB before they are composited,
// and back when a pixel is done, so the steps in between are unchanged.
//
//   colorist --linear--> SrgbColorist --sRGB--> samples, layers, background --sRGB--> LinearCanvas --linear--> canvas
#pragma once

#include "shade/canvas/canvas.h"

namespace frontmost::shading {

/// Colours like another colorist, which it borrows, but in sRGB.
struct SrgbColorist {
  const FragmentShader::Colorist& linear;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
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

}  // namespace frontmost::shading
