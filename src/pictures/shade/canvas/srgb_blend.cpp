// SPDX-License-Identifier: Apache-2.0
// Colours are not premultiplied while they are converted, because the curve is not linear. So a pixel is first divided
// by its alpha and multiplied afterwards; a clear pixel stays clear.

#include "shade/canvas/srgb_blend.h"

#include "base/srgb.h"
#include "shade/colorists.h"
#include "shade/light/layers.h"

namespace frontmost::shading {
namespace {

float srgb_of(float linear) { return float(srgb_of_linear(double(linear > 0 ? (linear < 1 ? linear : 1.0f) : 0.0f))); }

glm::vec4 linear_of_premultiplied(const glm::vec4& color) {
  if (!(color.a > 0)) return glm::vec4(0);
  return {linear_of_shown(glm::vec3(color) / color.a) * color.a, color.a};
}

}  // namespace

void SrgbColorist::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  linear(setups, batch);
  if (batch.layers.has_transmission) hide_by_highlights(batch);
  for (int i = 0; i < batch.coverage.count; ++i) {
    const glm::vec3 light = batch.light.at(i);
    batch.light.set(i, {srgb_of(light.x), srgb_of(light.y), srgb_of(light.z)});
  }
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

}  // namespace frontmost::shading
