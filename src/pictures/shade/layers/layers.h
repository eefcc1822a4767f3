// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes that can be seen through. The A-buffer knows what is before what and which sub-samples it covers;
// here every fragment gets its colour and its alpha, textures included.
#pragma once

#include <functional>

#include "abuffer/fragment_pass.h"
#include "base/pool.h"
#include "shade/canvas/canvas.h"

namespace frontmost::shading {

/// Adds every primitive that is seen, and perhaps some that something opaque hides. O(fragments).
void add_seen_primitives(const abuffer_detail::FragmentPass& pass,
                         const abuffer_detail::FragmentPass::LeaveOut& leave_out, BitSet& seen,
                         const Execution& execution);

/// Colours the fragments of one rectangle after another, from several threads at once.
class LayerShader {
 public:
  LayerShader(const TriangleSource& source, const abuffer_detail::FragmentPass& pass,
              const FragmentShader::Colorist& colorist, ShadingRate rate, Isa isa);

  /// Sets the colours of number numbers[i] for every fragment i: shaded at the middle of what it covers of its pixel.
  /// Two by two pixels share one where the same primitive covers the same samples, as many layers deep.
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

/// Shades every such fragment once and lays them over each other. `paint_otherwise` says of a tile whether it has
/// painted it, so that no layers of it are needed.
void shade_layers(const TriangleSource& source, const abuffer_detail::FragmentPass& pass,
                  const abuffer_detail::FragmentPass::LeaveOut& paint_otherwise, const Painting& painting,
                  const Execution& execution);

// Layers as data: every fragment with its colour, in the order of depth.

/// The parts of a pixel that its fragments show, nearest first: how much of the whole each contributes when they are
/// laid over each other in true order at every sub-sample. `alphas` are the fragments' own; `key_at(i, s)` is the key
/// of fragment i at sub-sample s. O(n * sub-samples) for n fragments that keep their order, O(n log n * sub-samples)
/// for others.
using KeyAt = std::function<float(std::size_t fragment, std::size_t sample)>;
[[nodiscard]] std::vector<float> shown_parts(std::span<const Fragment> fragments, std::span<const float> alphas,
                                             std::size_t sample_count, const KeyAt& key_at);

/// What shade_deep() gives, `opacity` being already in the pass.
[[nodiscard]] DeepImage deep_layers(const Surfaces& surfaces, const View& view,
                                    const abuffer_detail::FragmentPass& pass, const LayerShader& shader,
                                    const Execution& execution);

}  // namespace frontmost::shading
