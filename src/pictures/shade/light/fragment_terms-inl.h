// SPDX-License-Identifier: Apache-2.0
// Terms that all passes of light share. They are plain loops over lanes with only + - * / and square roots, and are
// compiled once for each instruction set. So compilers vectorize them, and every machine gives the same bits.

// This file is included once for every target.
#if defined(FRONTMOST_SHADE_LIGHT_FRAGMENT_TERMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_SHADE_LIGHT_FRAGMENT_TERMS_INL_H_
#undef FRONTMOST_SHADE_LIGHT_FRAGMENT_TERMS_INL_H_
#else
#define FRONTMOST_SHADE_LIGHT_FRAGMENT_TERMS_INL_H_
#endif

#include <cmath>

#include "base/highway-inl.h"
#include "shade/batch.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading::HWY_NAMESPACE {

struct Direction {
  float x, y, z;
};

inline float dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float at_least(float value, float least) { return value > least ? value : least; }  // `least` for NaN
inline float at_most(float value, float most) { return value < most ? value : most; }
inline float clamp01(float value) { return at_most(at_least(value, 0.0f), 1.0f); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }

inline Direction direction_of(const Lane3& lanes, int i) { return {lanes.x[i], lanes.y[i], lanes.z[i]}; }
inline Direction direction_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// Returns (1 - c)^5, for Schlick's approximation.
inline float fifth_power_below_one(float c) {
  const float x = clamp01(1.0f - c), x2 = x * x;
  return x2 * x2 * x;
}

/// Returns the roughness, limited to 0.09 to 1, because the highlight of a smoother surface could fall between two
/// pixels.
inline float shown_roughness(float roughness) { return at_most(at_least(roughness, 0.09f), 1.0f); }
/// Returns N.V, but at least a little above 0, because a bumpy normal may lean away from the viewer.
inline float towards_viewer(const Direction& normal, const Direction& to_viewer) {
  return at_least(dot(normal, to_viewer), 1e-3f);
}

/// The reflection of a material in one colour channel.
struct Reflection {
  float matt;        ///< diffuse share
  float f0;          ///< mirrored share at normal incidence
  float f90 = 1.0f;  ///< mirrored share at grazing incidence
};
/// The reflection in all colour channels.
struct Reflections {
  Reflection red, green, blue;
};
inline Reflection reflection_of(float base, float metallic) {
  constexpr float dielectric = 0.04f;
  return {base * (1.0f - metallic), mix(dielectric, base, metallic)};
}

/// The surfaces of a batch without LayerLanes::has_dielectric.
struct PlainSurface {
  static inline Reflections at(const FragmentBatch& batch, int i) {
    const Reflectance& m = batch.material;
    const float metallic = clamp01(m.metallic[i]);
    return {reflection_of(m.base.x[i], metallic), reflection_of(m.base.y[i], metallic),
            reflection_of(m.base.z[i], metallic)};
  }
  /// Returns the share of light that reaches the diffuse part of a channel. This is the share that the channel does not
  /// mirror, `own`.
  static inline float below(const FragmentBatch& /*batch*/, int /*i*/, float own, float /*least*/) { return own; }
};

/// The surfaces of a batch with LayerLanes::has_dielectric: some mirror differently, or transmit light.
struct LayeredSurface {
  static inline Reflections at(const FragmentBatch& batch, int i) {
    const Reflectance& m = batch.material;
    const LayerLanes& layers = batch.layers;
    const float metallic = clamp01(m.metallic[i]), stays = 1.0f - layers.transmission[i];
    const float f90 = mix(layers.f90[i], 1.0f, metallic);
    return {{m.base.x[i] * (1.0f - metallic) * stays, mix(layers.f0.x[i], m.base.x[i], metallic), f90},
            {m.base.y[i] * (1.0f - metallic) * stays, mix(layers.f0.y[i], m.base.y[i], metallic), f90},
            {m.base.z[i] * (1.0f - metallic) * stays, mix(layers.f0.z[i], m.base.z[i], metallic), f90}};
  }
  /// Returns the share of light that reaches the diffuse part of a channel. If the fragment's is_dielectric is 1, it is
  /// the least share of all channels, so that coloured mirroring does not tint the diffuse part.
  static inline float below(const FragmentBatch& batch, int i, float own, float least) {
    return batch.layers.is_dielectric[i] > 0.5f ? least : own;
  }
};

}  // namespace frontmost::shading::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
