// SPDX-License-Identifier: Apache-2.0
// Passes of light over a batch: lights, and the final mapping. All are plain loops over lanes.
#include "shade/light/lighting.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/light_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "shade/light/albedo.h"
// After Highway: a block of its own.
#include "shade/light/fragment_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace {

/// The terms of one fragment that do not depend on the colour channel.
struct DirectTerms {
  float diffuse;   ///< N.L times shadow
  float specular;  ///< N.L times shadow and the GGX lobe, without Fresnel
  float fresnel;   ///< (1 - V.H)^5
};

struct LobeInput {
  float n_l, n_v, n_h, roughness;
};

/// Returns the GGX distribution times Smith's height-correlated masking. The factor 1 / pi is part of the light's unit.
inline float ggx(const LobeInput& in) {
  const float alpha = in.roughness * in.roughness, alpha2 = alpha * alpha;
  const float t = in.n_h * in.n_h * (alpha2 - 1.0f) + 1.0f;
  const float view = in.n_l * std::sqrt(in.n_v * in.n_v * (1.0f - alpha2) + alpha2);
  const float light = in.n_v * std::sqrt(in.n_l * in.n_l * (1.0f - alpha2) + alpha2);
  return 0.5f * alpha2 / (t * t * at_least(view + light, 1e-6f));
}

inline DirectTerms direct_terms(const Direction& l, const FragmentBatch& batch, int i) {
  const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
  const Direction sum{v.x + l.x, v.y + l.y, v.z + l.z};
  const float scale = 1.0f / std::sqrt(at_least(dot(sum, sum), 1e-12f));
  const Direction h{sum.x * scale, sum.y * scale, sum.z * scale};
  const float roughness = shown_roughness(batch.material.roughness[i]);
  const float n_l = at_least(dot(n, l), 0.0f), n_v = towards_viewer(n, v);
  DirectTerms t;
  t.diffuse = n_l * batch.shadow[i];
  t.specular = t.diffuse * ggx({n_l, n_v, at_least(dot(n, h), 0.0f), roughness});
  t.fresnel = fifth_power_below_one(dot(v, h));
  return t;
}

/// Returns the mirrored share by Schlick's approximation.
inline float mirrored(const Reflection& m, const DirectTerms& t) { return m.f0 + (m.f90 - m.f0) * t.fresnel; }

/// Returns the reflected light of one channel. `below` is the share of the light that reaches the diffuse part.
inline float sent_back(const DirectTerms& t, float matt, float mirrored, float below) {
  return t.diffuse * matt * below + t.specular * mirrored;
}

/// Adds the light that surfaces reflect. direction_at(i) is the direction from fragment i to the light.
template <class Surface, class DirectionAt>
void AddToSurface(const glm::vec3& color, const DirectionAt& direction_at, FragmentBatch& batch) {
  const float red = color.x, green = color.y, blue = color.z;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const DirectTerms t = direct_terms(direction_at(i), batch, i);
    const Reflections m = Surface::at(batch, i);
    const float of_red = mirrored(m.red, t), of_green = mirrored(m.green, t), of_blue = mirrored(m.blue, t);
    const float least = at_most(at_most(1.0f - of_red, 1.0f - of_green), 1.0f - of_blue);
    batch.light.x[i] += red * sent_back(t, m.red.matt, of_red, Surface::below(batch, i, 1.0f - of_red, least));
    batch.light.y[i] += green * sent_back(t, m.green.matt, of_green, Surface::below(batch, i, 1.0f - of_green, least));
    batch.light.z[i] += blue * sent_back(t, m.blue.matt, of_blue, Surface::below(batch, i, 1.0f - of_blue, least));
  }
}

/// Adds the light that fibres scatter. The cloth below reflects light separately.
template <class DirectionAt>
void AddSheen(const glm::vec3& color, const DirectionAt& direction_at, FragmentBatch& batch) {
  LayerLanes& layers = batch.layers;
  const float red = color.x, green = color.y, blue = color.z;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction l = direction_at(i);
    const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
    const Direction sum{v.x + l.x, v.y + l.y, v.z + l.z};
    const float scale = 1.0f / std::sqrt(at_least(dot(sum, sum), 1e-12f));
    const float n_h = clamp01((dot(n, v) + dot(n, l)) * scale), n_l = clamp01(dot(n, l));
    const float lobe = sheen_of({n_l, towards_viewer(n, v), n_h}, shown_sheen_roughness(layers.sheen_roughness[i]));
    const float arrives = n_l * batch.shadow[i] * lobe;
    layers.sheen_light.x[i] += red * arrives * layers.sheen.x[i];
    layers.sheen_light.y[i] += green * arrives * layers.sheen.y[i];
    layers.sheen_light.z[i] += blue * arrives * layers.sheen.z[i];
  }
}

template <class DirectionAt>
void AddLight(const glm::vec3& color, const DirectionAt& direction_at, FragmentBatch& batch) {
  batch.layers.has_dielectric ? AddToSurface<LayeredSurface>(color, direction_at, batch)
                              : AddToSurface<PlainSurface>(color, direction_at, batch);
  if (batch.layers.has_sheen) AddSheen(color, direction_at, batch);
}

struct Channels {
  float r, g, b;
};

/// Khronos PBR Neutral Tone Mapper, 2024. A dielectric's reflection of grey surroundings, 0.04, is subtracted. If the
/// greatest channel is above 0.8 - 0.04, it is compressed to below 1, and the other channels move towards it.
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
    // The curve is level above this limit, which keeps squares finite.
    const Channels c{at_most(in.r * exposure, 1e15f), at_most(in.g * exposure, 1e15f), at_most(in.b * exposure, 1e15f)};
    const float r = curve(0.59719f * c.r + 0.35458f * c.g + 0.04823f * c.b);
    const float g = curve(0.07600f * c.r + 0.90834f * c.g + 0.01566f * c.b);
    const float b = curve(0.02840f * c.r + 0.13383f * c.g + 0.83777f * c.b);
    return {1.60475f * r - 0.53108f * g - 0.07367f * b, -0.10208f * r + 1.10813f * g - 0.00605f * b,
            -0.00327f * r - 0.07276f * g + 1.07602f * b};
  }
};

/// Returns the exposed light as a number that the curves can map: 0 to 1e30, and 0 for NaN.
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

/// Computes the light of a lamp at each fragment, by its distance, range window and cone.
void FindLampLight(const Lamp& lamp, const FragmentBatch& batch, LampLight& out) {
  const Lane3& position = batch.geometry.position;
  const Direction at = direction_of(lamp.position), axis = direction_of(lamp.axis);
  const float per_range2 = lamp.range > 0 ? 1.0f / (lamp.range * lamp.range) : 0.0f;
  const float scale = lamp.cone_scale, offset = lamp.cone_scale > 0 ? -lamp.cosine_outer * scale : 1.0f;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction to{at.x - position.x[i], at.y - position.y[i], at.z - position.z[i]};
    // A point at the lamp would get infinite light from no direction, so the least distance is 1e-4 units.
    const float distance2 = at_least(dot(to, to), 1e-8f), per_distance = 1.0f / std::sqrt(distance2);
    const Direction l{to.x * per_distance, to.y * per_distance, to.z * per_distance};
    const float in_range = distance2 * per_range2;
    const float window = at_least(1.0f - in_range * in_range, 0.0f);
    const float cone = clamp01(offset - dot(l, axis) * scale);
    out.to_lamp.x[i] = l.x;
    out.to_lamp.y[i] = l.y;
    out.to_lamp.z[i] = l.z;
    out.part[i] = window * (cone * cone) / distance2;
  }
}

void AddDirectLight(const DirectLight& light, FragmentBatch& batch) {
  const Direction to_light = direction_of(light.to_light);
  if (const Lane3* const directions = light.directions)
    AddLight(
        light.color, [&](int i) { return direction_of(*directions, i); }, batch);
  else
    AddLight(
        light.color, [&](int) { return to_light; }, batch);
  if (!batch.layers.has_coat) return;
  batch.coat->shadow = batch.shadow;
  AddDirectLight(light, *batch.coat);
}

void FinishLight(const Lighting& lighting, FragmentBatch& batch) {
  const auto unchanged = [](const Channels& c) { return c; };
  if (lighting.tone_mapping == ToneMapping::none) return FinishBy(unchanged, lighting.exposure, batch);
  if (lighting.tone_mapping == ToneMapping::aces) return FinishBy(Filmic{}, lighting.exposure, batch);
  FinishBy(KhronosNeutral{}, lighting.exposure, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FindLampLight);
FRONTMOST_KERNELS(AddDirectLight);
FRONTMOST_KERNELS(FinishLight);

void find_lamp_light(const Lamp& lamp, const FragmentBatch& batch, LampLight& light, Isa isa) {
  kernel_for(FindLampLightKernels, isa)(lamp, batch, light);
}

void add_direct_light(const DirectLight& light, FragmentBatch& batch, Isa isa) {
  kernel_for(AddDirectLightKernels, isa)(light, batch);
}

void finish_light(const Lighting& lighting, FragmentBatch& batch, Isa isa) {
  lay_layers_over(batch);
  kernel_for(FinishLightKernels, isa)(lighting, batch);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
