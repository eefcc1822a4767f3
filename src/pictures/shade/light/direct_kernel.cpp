// SPDX-License-Identifier: Apache-2.0

#include "shade/light/layers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/direct_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
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

/// GGX distribution times Smith's height-correlated masking. The factor 1 / pi is part of the light's unit.
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

/// The mirrored share by Schlick's approximation.
inline float mirrored(const Reflection& m, const DirectTerms& t) { return m.f0 + (m.f90 - m.f0) * t.fresnel; }

/// `below`: the share of the light that reaches the diffuse part.
inline float sent_back(const DirectTerms& t, float matt, float mirrored, float below) {
  return t.diffuse * matt * below + t.specular * mirrored;
}

/// `direction_at(i)` is the direction from fragment i to the light.
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

template <class DirectionAt>
void AddLight(const glm::vec3& color, const DirectionAt& direction_at, FragmentBatch& batch) {
  batch.layers.has_dielectric ? AddToSurface<LayeredSurface>(color, direction_at, batch)
                              : AddToSurface<PlainSurface>(color, direction_at, batch);
}

}  // namespace

void AddDirectLight(const DirectLight& light, FragmentBatch& batch) {
  const Direction to_light = direction_of(light.to_light);
  AddLight(
      light.color, [&](int) { return to_light; }, batch);
}

void AddLightFrom(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch) {
  AddLight(
      color, [&](int i) { return direction_of(to_light, i); }, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(AddDirectLight);
FRONTMOST_KERNELS(AddLightFrom);

void add_direct_light(const DirectLight& light, FragmentBatch& batch, Isa isa) {
  kernel_for(AddDirectLightKernels, isa)(light, batch);
  if (batch.layers.has_sheen) add_direct_sheen(light, batch, isa);
  if (!batch.layers.has_coat) return;
  batch.coat->shadow = batch.shadow;
  kernel_for(AddDirectLightKernels, isa)(light, *batch.coat);
}

void add_light_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa) {
  kernel_for(AddLightFromKernels, isa)(to_light, color, batch);
  if (batch.layers.has_sheen) add_sheen_from(to_light, color, batch, isa);
  if (!batch.layers.has_coat) return;
  batch.coat->shadow = batch.shadow;
  kernel_for(AddLightFromKernels, isa)(to_light, color, *batch.coat);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
