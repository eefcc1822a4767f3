// SPDX-License-Identifier: Apache-2.0
// Layers as data: every fragment with its colour, in the order of depth.
#pragma once

#include <functional>

#include "shade/layers/layers.h"

namespace frontmost::shading {

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
