// SPDX-License-Identifier: Apache-2.0
// The reference for the light kernels: one fragment at a time, in doubles, by the formulas of glTF 2.0 (appendix B:
// metallic-roughness, GGX, Smith's correlated masking, Schlick's Fresnel). A new term of a material needs one more
// function of a SeenSurface, and one more line in direct_light() and in surrounding_light().
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "frontmost/pictures.h"
#include "shade/light/lighting.h"

namespace frontmost::test {

struct Surface {
  glm::vec3 normal{0, 0, 1}, to_viewer{0, 0, 1};
  glm::vec3 base{1};
  float metallic = 0, roughness = 1, occlusion = 1, shadow = 1;
  glm::vec3 emissive{0};
  bool unlit = false;
};

inline void set(shading::FragmentBatch& batch, int i, const Surface& s) {
  batch.geometry.normal.set(i, glm::normalize(s.normal));
  batch.geometry.to_viewer.set(i, glm::normalize(s.to_viewer));
  batch.material.base.set(i, s.base);
  batch.material.emissive.set(i, s.emissive);
  batch.material.metallic[i] = s.metallic;
  batch.material.roughness[i] = s.roughness;
  batch.material.occlusion[i] = s.occlusion;
  batch.material.unlit[i] = s.unlit ? 1.0f : 0.0f;
  batch.shadow[i] = s.shadow;
}

/// Runs all passes, with the key light as the only direct light.
inline void light_batch(const shading::Lighting& lighting, shading::FragmentBatch& batch, Isa isa = Isa::best) {
  shading::begin_light(batch);
  if (lighting.key.is_on()) shading::add_direct_light(lighting.key, batch, isa);
  shading::add_surroundings(lighting.around, batch, isa);
  shading::finish_light(lighting, batch, isa);
}

/// Colour of the surface by the kernels.
inline glm::vec3 lit(const Surface& surface, const shading::Lighting& lighting = {}, Isa isa = Isa::best) {
  const auto batch = std::make_unique<shading::FragmentBatch>();
  batch->coverage.count = 1;
  set(*batch, 0, surface);
  light_batch(lighting, *batch, isa);
  return batch->light.at(0);
}

/// A surface and its view direction, in doubles.
struct SeenSurface {
  explicit SeenSurface(const Surface& s)
      : normal(glm::normalize(glm::dvec3(s.normal))),
        to_viewer(glm::normalize(glm::dvec3(s.to_viewer))),
        n_v(std::max(glm::dot(normal, to_viewer), 1e-3)),
        f0(glm::mix(glm::dvec3(0.04), glm::dvec3(s.base), double(s.metallic))),
        matt(glm::dvec3(s.base) * (1 - double(s.metallic))) {}
  glm::dvec3 normal, to_viewer;
  double n_v;
  glm::dvec3 f0, matt;
};

inline double fifth_power(double v) { return v * v * v * v * v; }

/// V of appendix B.3.3, which is G / (4 N.L N.V).
inline double masking(double n_l, double n_v, double alpha2) {
  return 0.5 /
         (n_l * std::sqrt(n_v * n_v * (1 - alpha2) + alpha2) + n_v * std::sqrt(n_l * n_l * (1 - alpha2) + alpha2));
}

/// Light from one direction. The key light's rim is soft: its roughness is at least 0.09.
inline glm::dvec3 direct_light(const Surface& s, const shading::DirectLight& light) {
  const SeenSurface sight(s);
  const glm::dvec3 l(light.to_light), h = glm::normalize(l + sight.to_viewer);
  const double n_l = glm::dot(sight.normal, l), n_h = glm::dot(sight.normal, h), v_h = glm::dot(sight.to_viewer, h);
  if (n_l <= 0) return glm::dvec3(0);
  const double alpha2 = std::pow(std::max(double(s.roughness), 0.09), 4), t = n_h * n_h * (alpha2 - 1) + 1;
  // Lights are given as the radiance that a white matt surface reflects, which is pi times less.
  const double lobe = alpha2 / (t * t) * masking(n_l, sight.n_v, alpha2);
  const glm::dvec3 fresnel = sight.f0 + (1.0 - sight.f0) * fifth_power(1 - std::abs(v_h));
  return glm::dvec3(light.color) * n_l * double(s.shadow) * ((1.0 - fresnel) * sight.matt + fresnel * lobe);
}

/// Share of uniform light that a perfect mirror of this roughness reflects, and Schlick's part of it.
inline glm::dvec2 mirrored_parts(double n_v, double roughness) {
  const double alpha2 = std::pow(std::max(roughness, 1e-3), 4);
  const glm::dvec3 v(std::sqrt(1 - n_v * n_v), 0, n_v);
  constexpr int tilts = 400, turns = 48;
  glm::dvec2 sum(0);
  for (int i = 0; i < tilts; ++i) {
    const double u = (i + 0.5) / tilts, cosine2 = (1 - u) / (1 + (alpha2 - 1) * u), n_h = std::sqrt(cosine2);
    for (int k = 0; k < turns; ++k) {
      const double turn = (k + 0.5) / turns * 3.14159265358979;
      const double v_h = std::sqrt(1 - cosine2) * std::cos(turn) * v.x + n_h * v.z, n_l = 2 * v_h * n_h - n_v;
      if (v_h <= 0 || n_l <= 0) continue;
      const double weight = masking(n_l, n_v, alpha2) * 4 * n_l * v_h / n_h;
      sum += weight * glm::dvec2(1, fifth_power(1 - v_h));
    }
  }
  return sum / double(tilts * turns);
}

/// Light from all around by the split sum, including multiple reflections.
inline glm::dvec3 surrounding_light(const Surface& s, const Environment& environment,
                                    const glm::mat3& world_from_environment) {
  const SeenSurface sight(s);
  const glm::dvec2 parts = mirrored_parts(std::min(sight.n_v, 1.0), double(s.roughness));
  const glm::dvec3 r = 2 * glm::dot(sight.normal, sight.to_viewer) * sight.normal - sight.to_viewer;
  const glm::dvec3 mirrored(environment.radiance(glm::vec3(r) * world_from_environment, s.roughness));
  const glm::dvec3 matt(environment.irradiance(glm::vec3(sight.normal) * world_from_environment));
  const glm::dvec3 once = sight.f0 * (parts.x - parts.y) + parts.y, mean = sight.f0 + (1.0 - sight.f0) / 21.0;
  const glm::dvec3 again = once * mean * (1 - parts.x) / (1.0 - mean * (1 - parts.x));
  return double(s.occlusion) * (once * mirrored + (again + sight.matt * (1.0 - once - again)) * matt);
}

}  // namespace frontmost::test
