// SPDX-License-Identifier: Apache-2.0

#include "shade/light/lighting.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/output_kernel.cpp"
#include <algorithm>

#include "base/highway-inl.h"
#include "base/isa.h"
#include "shade/light/layers.h"
// After Highway: a block of its own.
#include "shade/light/fragment_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {

namespace {

struct Channels {
  float r, g, b;
};

struct Uncompressed {
  inline Channels operator()(const Channels& c) const { return c; }
};

/// Khronos PBR Neutral Tone Mapper, 2024. A dielectric's reflection of grey surroundings, 0.04, is subtracted. Above
/// 0.8 - 0.04 the greatest channel approaches 1, and the others approach it.
struct KhronosNeutral {
  inline Channels operator()(const Channels& c) const {
    constexpr float start = 0.8f - 0.04f, rest = 1.0f - start, fading = 0.15f;
    const float least = at_most(at_most(c.r, c.g), c.b);
    const float offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
    const float r = c.r - offset, g = c.g - offset, b = c.b - offset;
    const float peak = at_least(at_least(r, g), b);
    const float above = at_least(peak - start, 0.0f);
    const float compressed = 1.0f - rest * rest / (above + rest);
    const bool is_bright = peak > start;
    const float scale = is_bright ? compressed / at_least(peak, start) : 1.0f;
    const float faded = is_bright ? 1.0f - 1.0f / (fading * (peak - compressed) + 1.0f) : 0.0f;
    const float white = is_bright ? compressed : 0.0f;
    return {mix(r * scale, white, faded), mix(g * scale, white, faded), mix(b * scale, white, faded)};
  }
};

/// S. Hill's fit of the ACES reference rendering transform and output transform for sRGB screens (the BakingLab sample
/// of M. Pettineo and D. Neubelt, 2016), with the usual exposure of 1 / 0.6.
struct Filmic {
  static inline float curve(float v) {
    return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
  }
  inline Channels operator()(const Channels& in) const {
    constexpr float exposure = 1.0f / 0.6f;
    // Above this value the curve is level; the limit keeps squares finite.
    const Channels c{at_most(in.r * exposure, 1e15f), at_most(in.g * exposure, 1e15f), at_most(in.b * exposure, 1e15f)};
    const float r = curve(0.59719f * c.r + 0.35458f * c.g + 0.04823f * c.b);
    const float g = curve(0.07600f * c.r + 0.90834f * c.g + 0.01566f * c.b);
    const float b = curve(0.02840f * c.r + 0.13383f * c.g + 0.83777f * c.b);
    return {1.60475f * r - 0.53108f * g - 0.07367f * b, -0.10208f * r + 1.10813f * g - 0.00605f * b,
            -0.00327f * r - 0.07276f * g + 1.07602f * b};
  }
};

/// Maps any number to the domain of the curves.
inline float exposed(float light, float exposure) { return at_most(at_least(light * exposure, 0.0f), 1e30f); }

template <class Map>
void FinishBy(const Map& map, float exposure, FragmentBatch& batch) {
  const Reflectance& m = batch.material;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const bool is_unlit = m.unlit[i] > 0.5f;
    const Channels c = map({exposed(batch.light.x[i], exposure), exposed(batch.light.y[i], exposure),
                            exposed(batch.light.z[i], exposure)});
    batch.light.x[i] = clamp01(is_unlit ? m.base.x[i] : c.r);
    batch.light.y[i] = clamp01(is_unlit ? m.base.y[i] : c.g);
    batch.light.z[i] = clamp01(is_unlit ? m.base.z[i] : c.b);
  }
}

}  // namespace

void FinishLight(const Lighting& lighting, FragmentBatch& batch) {
  if (lighting.tone_mapping == ToneMapping::none) return FinishBy(Uncompressed{}, lighting.exposure, batch);
  if (lighting.tone_mapping == ToneMapping::aces) return FinishBy(Filmic{}, lighting.exposure, batch);
  FinishBy(KhronosNeutral{}, lighting.exposure, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FinishLight);

void begin_light(FragmentBatch& batch) {
  const auto copy = [&](const Lane& from, Lane& to) {
    std::copy_n(from.values, std::size_t(batch.coverage.count), to.values);
  };
  copy(batch.material.emissive.x, batch.light.x);
  copy(batch.material.emissive.y, batch.light.y);
  copy(batch.material.emissive.z, batch.light.z);
  begin_layers(batch);
}

void finish_light(const Lighting& lighting, FragmentBatch& batch, Isa isa) {
  lay_layers_over(batch);
  kernel_for(FinishLightKernels, isa)(lighting, batch);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
