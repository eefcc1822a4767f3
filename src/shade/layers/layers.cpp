// SPDX-License-Identifier: Apache-2.0
#include "shade/layers/layers.h"

namespace frontmost::shading {

using abuffer_detail::FragmentPass;
using abuffer_detail::PixelLists;
using abuffer_detail::Rectangle;

LayerShader::LayerShader(const TriangleSource& source, const FragmentPass& pass,
                         const FragmentShader::Colorist& colorist, Isa isa)
    : source_(source), colorist_(colorist), isa_(isa) {
  for (const glm::ivec2& s : pass.samples()) positions_.push_back(glm::vec2(s) / 256.0f);
}

glm::vec2 LayerShader::centroid(std::uint64_t mask) const {
  glm::vec2 sum(0);
  float count = 0;
  for (std::size_t s = 0; s < positions_.size(); ++s)
    if (mask >> s & 1) {
      sum += positions_[s];
      ++count;
    }
  return sum / count;
}

void LayerShader::shade(const Rectangle& pixels, const PixelLists& lists, std::span<const std::uint32_t> numbers,
                        std::vector<glm::vec4>& colors) const {
  const auto shader = shaders_.borrow([] { return std::make_unique<FragmentShader>(); });
  const auto receive = [&](std::uint32_t number, float, const glm::vec3& light, float alpha) {
    colors[number] = glm::vec4(light, alpha);
  };
  shader->begin(source_, colorist_, isa_);
  for (std::size_t p = 0; p + 1 < lists.begin.size(); ++p) {
    const glm::vec2 corner(float(pixels.x + int(p) % pixels.width), float(pixels.y + int(p) / pixels.width));
    for (std::size_t i = lists.begin[p]; i < lists.begin[p + 1]; ++i) {
      if (shader->is_full()) shader->hand_out(receive);
      const Fragment& f = lists.fragments[i];
      shader->add(f.primitive, numbers[i], corner + centroid(f.mask), f.mask, 1.0f);
    }
  }
  shader->hand_out(receive);
}

BitSet seen_primitives(const Surfaces& surfaces, const FragmentPass& pass, const Execution& execution) {
  BitSet seen(surfaces.primitive_count());
  pass.list_primitives(
      [&](std::span<const PrimitiveId> primitives) {
        for (const PrimitiveId id : primitives) seen.add(id);
      },
      execution);
  return seen;
}

void shade_layers(const TriangleSource& source, const FragmentPass& pass, const Painting& painting,
                  const Execution& execution) {
  const LayerShader shader(source, pass, painting.colorist, execution.isa);
  const auto paint = [&](const Rectangle& pixels, const PixelLists& lists, std::vector<glm::vec4>& colors) {
    shader.shade(pixels, lists, lists.numbers, colors);
  };
  const auto receive = [&](const Rectangle& r, const std::vector<glm::vec4>* pixels) {
    const TileRectangle tile{r.x, r.y, r.width, r.height};
    if (pixels)
      painting.canvas.write(tile, *pixels, painting.background);
    else
      painting.canvas.fill(tile, painting.background);
  };
  pass.paint(paint, receive, execution);
}

}  // namespace frontmost::shading
