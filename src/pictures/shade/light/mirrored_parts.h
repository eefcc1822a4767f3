// SPDX-License-Identifier: Apache-2.0
// What a surface mirrors of light that is 1 everywhere, by the angle of the viewer and the roughness: the second half
// of the split sum. (B. Karis. Real Shading in Unreal Engine 4. SIGGRAPH 2013 course.)
#pragma once

#include <array>
#include <cstddef>

namespace frontmost::shading {

/// Of the GGX lobe with Smith's correlated masking, rows by roughness and columns by the square root of N.V, both from
/// 0 to 1. Bilinear it is right to 0.001, at N.V below 0.02 and roughness below 0.1 to 0.011.
struct MirroredParts {
  static constexpr int size = 32, channels = 4;  ///< as many as colours have, so that both are read alike
  /// In turn: the part that a surface mirrors which mirrors everything, what of it Schlick's (1 - V.H)^5 takes, and
  /// twice nothing.
  std::array<float, std::size_t(channels* size* size)> values;
};

[[nodiscard]] const MirroredParts& mirrored_parts();

}  // namespace frontmost::shading
