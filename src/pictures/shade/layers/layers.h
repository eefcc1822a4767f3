// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes with see-through materials. The A-buffer knows the order of fragments and their sub-samples; here
// every fragment gets its colour and its alpha, textures included.
#pragma once

#include <functional>

#include "abuffer/fragment_pass.h"
#include "base/pool.h"
#include "shade/canvas/canvas.h"

namespace frontmost::shading {

/// Adds every visible primitive to `seen`, and possibly some behind opaque ones. O(fragments).
void add_seen_primitives(const abuffer_detail::FragmentPass& pass,
                         const abuffer_detail::FragmentPass::LeaveOut& leave_out, BitSet& seen,
                         const Execution& execution);

/// Colours the fragments of rectangles, one after another; several threads may call at once.
class LayerShader {
 public:
  LayerShader(const TriangleSource& source, const abuffer_detail::FragmentPass& pass,
              const FragmentShader::Colorist& colorist, ShadingRate rate, Isa isa);

  /// Sets the colour numbers[i] of every fragment i, shaded at the mean of its samples. At each_2x2, 2 x 2 pixels share
  /// a colour where the same primitive covers the same samples at the same depth rank.
  void shade(const abuffer_detail::Rectangle& pixels, const abuffer_detail::PixelLists& lists,
             std::span<const std::uint32_t> numbers, abuffer_detail::FragmentColors& colors) const;

 private:
  /// The mean of the covered positions, in pixels.
  [[nodiscard]] glm::vec2 centroid(std::uint64_t mask) const;

  const TriangleSource& source_;
  const FragmentShader::Colorist& colorist_;
  ShadingRate rate_;
  Isa isa_;
  std::vector<glm::vec2> positions_;  ///< of the masks' bits
  mutable Pool<FragmentShader> shaders_;
};

/// Shades every visible fragment once and composites them. `paint_otherwise` returns whether it has painted a tile,
/// which then needs no layers.
void shade_layers(const TriangleSource& source, const abuffer_detail::FragmentPass& pass,
                  const abuffer_detail::FragmentPass::LeaveOut& paint_otherwise, const Painting& painting,
                  const Execution& execution);

// Layers as data: every fragment with its colour, in depth order.

/// The visible share of a pixel for each of its fragments, which come nearest first: its contribution when fragments
/// are composited in exact order at every sub-sample. `alphas` are the fragments' own; `key_at(i, s)` is the key of
/// fragment i at sub-sample s. O(n * sub-samples) for n fragments that keep their order, else O(n log n * sub-samples).
using KeyAt = std::function<float(std::size_t fragment, std::size_t sample)>;
[[nodiscard]] std::vector<float> shown_parts(std::span<const Fragment> fragments, std::span<const float> alphas,
                                             std::size_t sample_count, const KeyAt& key_at);

/// The result of shade_deep(); the pass already has the opacity.
[[nodiscard]] DeepImage deep_layers(const Surfaces& surfaces, const View& view,
                                    const abuffer_detail::FragmentPass& pass, const LayerShader& shader,
                                    const Execution& execution);

}  // namespace frontmost::shading
