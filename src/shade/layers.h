// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes that can be seen through. The A-buffer knows what is before what and which sub-samples it covers;
// here every fragment gets its colour and its alpha, textures included.
#pragma once

#include "abuffer/fragment_pass.h"
#include "shade/canvas.h"

namespace frontmost::shading {

/// Every primitive that has a fragment which nothing opaque hides. O(fragments).
[[nodiscard]] BitSet seen_primitives(const Surfaces& surfaces, const abuffer_detail::FragmentPass& pass,
                                     const Execution& execution);

/// Shades every such fragment once, at the middle of what it covers of the pixel, and lays them over each other.
void shade_layers(const TriangleSource& source, const abuffer_detail::FragmentPass& pass, const Painting& painting,
                  const Execution& execution);

}  // namespace frontmost::shading
