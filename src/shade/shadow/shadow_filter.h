// SPDX-License-Identifier: Apache-2.0
// The soft edge of a shadow: a weighted mean of comparisons.
#pragma once

#include <cstddef>

#include "frontmost/base.h"

namespace frontmost::shading {

inline constexpr int shadow_taps = 8;  ///< of the filter along each axis

/// The window of a shadow map that a point is compared with, and the weights of its columns and rows.
struct ShadowWindow {
  const float* keys;   ///< of the first texel; the map lies by columns
  std::size_t stride;  ///< from column to column
  float key;           ///< the point's own: lit where the map's is not greater
  float across[shadow_taps], down[shadow_taps];
};

/// The sum of the weights of what is lit.
using ShadowFilter = float (*)(const ShadowWindow& window);

[[nodiscard]] ShadowFilter shadow_filter(Isa isa);

}  // namespace frontmost::shading
