// SPDX-License-Identifier: Apache-2.0
// Tables of the share that surfaces reflect of light that is 1 everywhere, for mirrors and for sheen, and the formula
// of sheen.
#pragma once

#include <array>
#include <cstddef>

#include "shade/powers.h"

namespace frontmost::shading {

/// The share that a surface mirrors of light that is 1 everywhere, by view angle and roughness. It is the second factor
/// of the split sum. (B. Karis. Real Shading in Unreal Engine 4. SIGGRAPH 2013 course.)
///
/// The lobe is GGX with Smith's correlated masking. Rows are by roughness and columns by the square root of N.V, both
/// from 0 to 1. Bilinear look-ups are correct to 0.001; at N.V below 0.02 and roughness below 0.1, to 0.011.
struct MirroredParts {
  static constexpr int size = 32, channels = 4;  ///< four channels, so that colours and parts are read alike
  /// The channels are the share for a surface that mirrors everything, that share weighted by (1 - V.H)^5 of Schlick's
  /// approximation, and two unused zeros.
  std::array<float, std::size_t(channels* size* size)> values;
};

[[nodiscard]] const MirroredParts& mirrored_parts();

/// The least roughness of sheen, because fibres that all stand in one direction would shine at a single angle.
inline constexpr float least_sheen_roughness = 0.1f;
/// Returns the roughness clamped to [least_sheen_roughness, 1], or `least_sheen_roughness` for NaN.
[[nodiscard]] inline float shown_sheen_roughness(float roughness) {
  const float bounded = roughness < 1.0f ? roughness : 1.0f;
  return bounded > least_sheen_roughness ? bounded : least_sheen_roughness;
}

struct SheenAngles {
  float n_l, n_v, n_h;  ///< N.V above 0, the others 0 or more
};
/// Evaluates the sheen of fibres that stand out of a cloth, by KHR_materials_sheen: they mirror light if the half
/// vector is perpendicular to them, and so shine at the rim.
///
///   distribution   (2 + 1/a) / 2 * sin(N.H)^(1/a), a = roughness squared    A. Estevez, C. Kulla. Production Friendly
///                  (the factor 1 / pi is the light's)                       Microfacet Sheen BRDF. SIGGRAPH 2017.
///   visibility     1 / (4 (N.L + N.V - N.L N.V))                            M. Ashikhmin, S. Premoze.
///                                                                           Distribution-based BRDFs. 2007.
///
/// \returns the light that white fibres scatter from one direction, before the factor N.L.
[[nodiscard]] inline float sheen_of(const SheenAngles& in, float shown_roughness) {
  const float sharpness = 1.0f / (shown_roughness * shown_roughness);
  const float sine2 = 1.0f - in.n_h * in.n_h;
  const float lobe = exp2_of(0.5f * sharpness * log2_of(sine2 > 1e-20f ? sine2 : 1e-20f));
  return (2.0f + sharpness) * lobe / (8.0f * (in.n_l + in.n_v - in.n_l * in.n_v));
}

/// The share that white fibres scatter of light that is 1 everywhere, and so keep from the surface below.
struct SheenAlbedo {
  static constexpr int size = 24;
  /// Rows are by roughness, from least_sheen_roughness to 1, and columns by the square root of N.V.
  std::array<float, std::size_t(size* size)> values;

  /// Interpolates bilinearly. The error is at most 0.015, and at most 0.006 if the roughness is above 0.2.
  [[nodiscard]] float at(float n_v, float shown_roughness) const;
};
[[nodiscard]] const SheenAlbedo& sheen_albedo();

}  // namespace frontmost::shading
