// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes with see-through materials. The A-buffer has the fragments of each pixel in depth order, with
// their sub-samples. Here every fragment gets its colour and its alpha, textures included.
#pragma once

#include <functional>

#include "abuffer/fragment_pass.h"
#include "shade/canvas/canvas.h"

namespace frontmost::shading {

/// Shades every visible fragment once and composites them. `paint_otherwise` may paint a tile itself, which then needs
/// no layers. It returns whether it did.
void shade_layers(const TriangleSource& source, const abuffer_detail::FragmentPass& pass,
                  const abuffer_detail::FragmentPass::LeaveOut& paint_otherwise, const Painting& painting,
                  const Execution& execution);

/// Returns, for each fragment of a pixel, the share that it contributes to the pixel if fragments are composited in
/// exact order at every sub-sample. The fragments come nearest first. `alphas` are the fragments' own; key_at(i, s) is
/// the key of fragment i at sub-sample s. O(n * sub-samples) for n fragments that keep their order, else O(n log n *
/// sub-samples).
using KeyAt = std::function<float(std::size_t fragment, std::size_t sample)>;
[[nodiscard]] std::vector<float> shown_parts(std::span<const Fragment> fragments, std::span<const float> alphas,
                                             std::size_t sample_count, const KeyAt& key_at);

/// Returns the result of shade_deep(): every fragment with its colour, in depth order. The opacity is that of the pass.
[[nodiscard]] DeepImage deep_layers(const Surfaces& surfaces, const View& view, const TriangleSource& source,
                                    const abuffer_detail::FragmentPass& pass, const FragmentShader::Colorist& colorist,
                                    const Execution& execution);

}  // namespace frontmost::shading
