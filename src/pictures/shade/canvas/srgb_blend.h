// SPDX-License-Identifier: Apache-2.0
// Blending as viewers of figures blend, in the numbers that are shown: colours are turned to sRGB before they are laid
// over each other, and back when a pixel is done, so that nothing in between has to know.
//
//   colorist --linear--> SrgbColorist --sRGB--> samples, layers, background --sRGB--> LinearCanvas --linear--> canvas
#pragma once

#include "shade/canvas/canvas.h"

namespace frontmost::shading {

/// Colours as another colorist, which is borrowed, but in sRGB.
struct SrgbColorist {
  const FragmentShader::Colorist& linear;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

/// Takes pixels in sRGB, premultiplied, over a background in sRGB, and paints them in linear light on another canvas,
/// which is borrowed.
class LinearCanvas final : public TileCanvas {
 public:
  explicit LinearCanvas(TileCanvas& canvas) : canvas_(canvas) {}
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;

 private:
  TileCanvas& canvas_;
};

}  // namespace frontmost::shading
