// SPDX-License-Identifier: Apache-2.0
// The share of light that a surface mirrors if it is 1 everywhere, by view angle and roughness: the second factor of
// the split sum. (B. Karis. Real Shading in Unreal Engine 4. SIGGRAPH 2013 course.)
#pragma once

#include <array>
#include <cstddef>

namespace frontmost::shading {

/// For the GGX lobe with Smith's correlated masking. Rows are by roughness and columns by the square root of N.V, both
/// from 0 to 1. Bilinear look-ups are correct to 0.001; at N.V below 0.02 and roughness below 0.1, to 0.011.
struct MirroredParts {
  static constexpr int size = 32, channels = 4;  ///< four, like colours, so that both are read alike
  /// Channels: the share mirrored by a surface that mirrors everything, the part of it with Schlick's (1 - V.H)^5, and
  /// two unused zeros.
  std::array<float, std::size_t(channels* size* size)> values;
};

[[nodiscard]] const MirroredParts& mirrored_parts();

}  // namespace frontmost::shading
