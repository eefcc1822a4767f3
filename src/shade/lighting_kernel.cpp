// SPDX-License-Identifier: Apache-2.0
// Plain loops over lanes with nothing but + - * / and square roots, compiled once for each instruction set: the
// compiler takes several fragments at a time, and every machine gives the same bits.

#include "shade/lighting.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/lighting_kernel.cpp"
#include <cmath>

#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace {

struct Direction {
  float x, y, z;
};

inline float dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float at_least(float value, float least) { return value > least ? value : least; }  // `least` for NaN
inline float at_most(float value, float most) { return value < most ? value : most; }
inline float clamp01(float value) { return at_most(at_least(value, 0.0f), 1.0f); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
inline float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

/// (1 - c)^5, of Schlick's approximation.
inline float fifth_power_below_one(float c) {
  const float x = clamp01(1.0f - c), x2 = x * x;
  return x2 * x2 * x;
}

inline Direction direction_of(const Lane3& lanes, int i) { return {lanes.x[i], lanes.y[i], lanes.z[i]}; }
inline Direction direction_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// What does not depend on the colour channel, for one fragment.
struct Terms {
  float key_diffuse;     ///< N.L and shadow
  float key_specular;    ///< the same times the GGX lobe without Fresnel
  float key_fresnel;     ///< (1 - V.H)^5
  float around_fresnel;  ///< (1 - N.V)^5
  float smoothness;
  float height;            ///< 0: the normal points straight down, 1: up
  float reflected_height;  ///< likewise of the mirrored view, blurred by the roughness
  float reflected_key;     ///< how much of the soft box around the key light is mirrored
};

struct LobeInput {
  float n_l, n_v, n_h, roughness;
};

/// GGX distribution times Smith's height-correlated masking, without the factor 1 / pi that the light's unit holds.
inline float ggx(const LobeInput& in) {
  const float alpha = in.roughness * in.roughness, alpha2 = alpha * alpha;
  const float t = in.n_h * in.n_h * (alpha2 - 1.0f) + 1.0f;
  const float view = in.n_l * std::sqrt(in.n_v * in.n_v * (1.0f - alpha2) + alpha2);
  const float light = in.n_v * std::sqrt(in.n_l * in.n_l * (1.0f - alpha2) + alpha2);
  return 0.5f * alpha2 / (t * t * at_least(view + light, 1e-6f));
}

inline Terms terms_of(const Lighting& lighting, const FragmentBatch& batch, int i) {
  const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
  const Direction l = direction_of(lighting.to_key), up = direction_of(lighting.up);
  const Direction sum{v.x + l.x, v.y + l.y, v.z + l.z};
  const float scale = 1.0f / std::sqrt(at_least(dot(sum, sum), 1e-12f));
  const Direction h{sum.x * scale, sum.y * scale, sum.z * scale};
  // Roughness 0 would put the highlight between two pixels; a bumpy normal may lean away from the viewer.
  const float roughness = mix(0.09f, 1.0f, clamp01(batch.material.roughness[i]));
  const float n_l = at_least(dot(n, l), 0.0f), n_v = at_least(dot(n, v), 1e-3f);
  const float twice = 2.0f * dot(n, v);
  const Direction r{twice * n.x - v.x, twice * n.y - v.y, twice * n.z - v.z};
  // The horizon of the surrounding is as soft as the surface is rough.
  const float sharpness = 0.5f / mix(0.12f, 1.0f, roughness);
  const float box = clamp01((dot(r, l) - mix(0.80f, -0.4f, roughness)) / mix(0.10f, 1.4f, roughness));
  Terms t;
  t.key_diffuse = n_l * batch.shadow[i];
  t.key_specular = t.key_diffuse * ggx({n_l, n_v, at_least(dot(n, h), 0.0f), roughness});
  t.key_fresnel = fifth_power_below_one(dot(v, h));
  t.around_fresnel = fifth_power_below_one(n_v);
  t.smoothness = 1.0f - roughness;
  t.height = 0.5f + 0.5f * dot(n, up);
  t.reflected_height = smooth(clamp01(0.5f + dot(r, up) * sharpness));
  t.reflected_key = smooth(box) * t.smoothness;  // rough ones have it in their highlight
  return t;
}

/// One colour channel of the light, and of the material.
struct Colors {
  float key, sky, ground, box;
};
struct Response {
  float base, metallic, occlusion, emissive;
};

inline float shaded(const Terms& t, const Colors& light, const Response& m) {
  constexpr float dielectric = 0.04f;
  const float f0 = mix(dielectric, m.base, m.metallic);
  const float matt = m.base * (1.0f - m.metallic);
  const float key_fresnel = f0 + (1.0f - f0) * t.key_fresnel;
  const float key = light.key * (t.key_diffuse * matt * (1.0f - key_fresnel) + t.key_specular * key_fresnel);
  // Rough surfaces shimmer less at grazing angles (S. Lagarde's variant of Schlick's term).
  const float around_fresnel = f0 + (at_least(t.smoothness, f0) - f0) * t.around_fresnel;
  const float around_matt = mix(light.ground, light.sky, t.height) * matt * (1.0f - around_fresnel);
  const float mirrored = mix(light.ground, light.sky, t.reflected_height) * 1.4f + light.box * t.reflected_key;
  return m.emissive + key + m.occlusion * (around_matt + around_fresnel * mirrored);
}

}  // namespace

void LightBatch(const Lighting& lighting, FragmentBatch& batch) {
  const Reflectance& m = batch.material;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Terms t = terms_of(lighting, batch, i);
    const float metallic = clamp01(m.metallic[i]), occlusion = m.occlusion[i];
    const bool is_unlit = m.unlit[i] > 0.5f;
    const float r = shaded(t, {lighting.key.x, lighting.sky.x, lighting.ground.x, lighting.key.x * lighting.box},
                           {m.base.x[i], metallic, occlusion, m.emissive.x[i]});
    const float g = shaded(t, {lighting.key.y, lighting.sky.y, lighting.ground.y, lighting.key.y * lighting.box},
                           {m.base.y[i], metallic, occlusion, m.emissive.y[i]});
    const float b = shaded(t, {lighting.key.z, lighting.sky.z, lighting.ground.z, lighting.key.z * lighting.box},
                           {m.base.z[i], metallic, occlusion, m.emissive.z[i]});
    batch.light.x[i] = clamp01(is_unlit ? m.base.x[i] : r);
    batch.light.y[i] = clamp01(is_unlit ? m.base.y[i] : g);
    batch.light.z[i] = clamp01(is_unlit ? m.base.z[i] : b);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(LightBatch);

Lighting lighting_for(const View& view, Axis up) {
  Lighting lighting;
  const glm::dvec3 towards = -0.48 * view.right() + 0.68 * view.up() - 0.72 * view.forward();
  lighting.to_key = glm::vec3(glm::normalize(towards));
  lighting.up = glm::vec3(direction(up));
  return lighting;
}

void light_batch(const Lighting& lighting, FragmentBatch& batch, Isa isa) {
  kernel_for(LightBatchKernels, isa)(lighting, batch);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
