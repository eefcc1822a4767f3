// SPDX-License-Identifier: Apache-2.0
#include "shade/layers/layers.h"

namespace frontmost::shading {

using abuffer_detail::FragmentColors;
using abuffer_detail::FragmentPass;
using abuffer_detail::PaintedPixels;
using abuffer_detail::PixelLists;
using abuffer_detail::Rectangle;

namespace {

/// The first fragment within the 2 x 2 pixels around pixel p that has the same primitive, the same samples and the same
/// depth rank as fragment `i`; `i` itself if none comes before it.
std::size_t shared_fragment(const Rectangle& pixels, const PixelLists& lists, std::size_t p, std::size_t i) {
  const auto width = std::size_t(pixels.width), x = p % width, y = p / width;
  const std::size_t left = x - x % 2, top = y - y % 2;
  for (const auto& [column, row] : {std::pair(left, top), std::pair(left + 1, top), std::pair(left, top + 1)}) {
    const std::size_t other = row * width + column;
    if (column == width || other >= p) continue;
    const std::size_t same = lists.begin[other] + (i - lists.begin[p]);
    if (same >= lists.begin[other + 1]) continue;
    const Fragment &own = lists.fragments[i], &found = lists.fragments[same];
    if (found.primitive == own.primitive && found.mask == own.mask) return same;
  }
  return i;
}

}  // namespace

LayerShader::LayerShader(const TriangleSource& source, const FragmentPass& pass,
                         const FragmentShader::Colorist& colorist, ShadingRate rate, Isa isa)
    : source_(source), colorist_(colorist), rate_(rate), isa_(isa) {
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
                        FragmentColors& colors) const {
  const auto shader = shaders_.borrow([] { return std::make_unique<FragmentShader>(); });
  const auto receive = [&](const FragmentShader::Shaded& s) { colors.set(s.number, s.light, s.alpha, s.alphas); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // from, to
  shader->begin(source_, colorist_, isa_);
  for (std::size_t p = 0; p + 1 < lists.begin.size(); ++p) {
    const glm::vec2 corner(float(pixels.x + int(p) % pixels.width), float(pixels.y + int(p) / pixels.width));
    for (std::size_t i = lists.begin[p]; i < lists.begin[p + 1]; ++i) {
      const Fragment& f = lists.fragments[i];
      if (rate_ == ShadingRate::each_2x2)
        if (const std::size_t same = shared_fragment(pixels, lists, p, i); same != i) {
          shared.push_back({numbers[same], numbers[i]});
          continue;
        }
      if (shader->is_full()) shader->hand_out(receive);
      shader->add(f.primitive, numbers[i], corner + centroid(f.mask), f.mask, 1.0f);
    }
  }
  shader->hand_out(receive);
  for (const auto& [from, to] : shared) colors.copy(from, to);
}

void add_seen_primitives(const FragmentPass& pass, const FragmentPass::LeaveOut& leave_out, BitSet& seen,
                         const Execution& execution) {
  const auto note = [&](std::span<const PrimitiveId> primitives) {
    for (const PrimitiveId id : primitives) seen.add(id);
  };
  pass.list_primitives(note, leave_out, execution);
}

void shade_layers(const TriangleSource& source, const FragmentPass& pass, const FragmentPass::LeaveOut& paint_otherwise,
                  const Painting& painting, const Execution& execution) {
  const LayerShader shader(source, pass, painting.colorist, painting.rate, execution.isa);
  const auto paint = [&](const Rectangle& pixels, const PixelLists& lists, FragmentColors& colors) {
    shader.shade(pixels, lists, lists.numbers, colors);
  };
  const glm::vec4& background = painting.background;
  const auto receive = [&](const Rectangle& r, const PaintedPixels* painted) {
    const TileRectangle tile{r.x, r.y, r.width, r.height};
    if (!painted)
      painting.canvas.fill(tile, background);
    else if (painted->alphas.empty())
      painting.canvas.write(tile, painted->colors, background);
    else
      painting.canvas.write_tinted(tile, *painted, background);
  };
  pass.paint(paint, receive, paint_otherwise, execution);
}

}  // namespace frontmost::shading
