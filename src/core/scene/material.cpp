// SPDX-License-Identifier: Apache-2.0
// Properties of every material, whoever made it: the textures that it uses, and numbers within their ranges.
#include "scene/material.h"

#include <algorithm>
#include <cmath>

namespace frontmost {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float largest_number = 1e12f;

/// Pointers to all texture uses of a material; pointers to const for a const material.
template <class M>
auto uses_of(M& m) {
  return std::array{&m.base_color_texture,
                    &m.metallic_roughness_texture,
                    &m.normal_texture,
                    &m.emissive_texture,
                    &m.occlusion_texture,
                    &m.specular.factor_texture,
                    &m.specular.color_texture,
                    &m.clearcoat.factor_texture,
                    &m.clearcoat.roughness_texture,
                    &m.clearcoat.normal_texture,
                    &m.sheen.color_texture,
                    &m.sheen.roughness_texture,
                    &m.transmission.factor_texture,
                    &m.volume.thickness_texture};
}

}  // namespace

std::array<TextureUse*, 14> texture_uses_of(Material& material) { return uses_of(material); }
std::array<const TextureUse*, 14> texture_uses_of(const Material& material) { return uses_of(material); }

float MaterialNumber::in_range() const { return std::isnan(*value) ? otherwise : std::clamp(*value, least, greatest); }

std::array<MaterialNumber, material_number_count> numbers_of(Material& m) {
  // An ior below 1 would make light faster than in a vacuum; but 0 stands for a mirror.
  const float least_ior = m.ior > 0 ? 1.0f : 0.0f;
  return {{{"baseColorFactor", &m.base_color.x, 0, 1, 1},
           {"baseColorFactor", &m.base_color.y, 0, 1, 1},
           {"baseColorFactor", &m.base_color.z, 0, 1, 1},
           {"baseColorFactor", &m.base_color.w, 0, 1, 1},
           {"metallicFactor", &m.metallic, 0, 1, 0},
           {"roughnessFactor", &m.roughness, 0, 1, 0.6f},
           {"emissiveFactor", &m.emissive.x, 0, largest_number, 0},
           {"emissiveFactor", &m.emissive.y, 0, largest_number, 0},
           {"emissiveFactor", &m.emissive.z, 0, largest_number, 0},
           {"occlusionTexture.strength", &m.occlusion_strength, 0, 1, 1},
           {"ior", &m.ior, least_ior, largest_number, 1.5f},
           {"specularFactor", &m.specular.factor, 0, 1, 1},
           {"specularColorFactor", &m.specular.color.x, 0, largest_number, 1},
           {"specularColorFactor", &m.specular.color.y, 0, largest_number, 1},
           {"specularColorFactor", &m.specular.color.z, 0, largest_number, 1},
           {"clearcoatFactor", &m.clearcoat.factor, 0, 1, 0},
           {"clearcoatRoughnessFactor", &m.clearcoat.roughness, 0, 1, 0},
           {"clearcoatNormalTexture.scale", &m.clearcoat.normal_scale, -largest_number, largest_number, 1},
           {"sheenColorFactor", &m.sheen.color.x, 0, 1, 0},
           {"sheenColorFactor", &m.sheen.color.y, 0, 1, 0},
           {"sheenColorFactor", &m.sheen.color.z, 0, 1, 0},
           {"sheenRoughnessFactor", &m.sheen.roughness, 0, 1, 0},
           {"transmissionFactor", &m.transmission.factor, 0, 1, 0},
           {"thicknessFactor", &m.volume.thickness, 0, largest_number, 0},
           {"attenuationDistance", &m.volume.attenuation_distance, 1 / largest_number, infinite, infinite},
           {"attenuationColor", &m.volume.attenuation_color.x, 0, 1, 1},
           {"attenuationColor", &m.volume.attenuation_color.y, 0, 1, 1},
           {"attenuationColor", &m.volume.attenuation_color.z, 0, 1, 1}}};
}

void limit_numbers(Material& material) {
  for (const MaterialNumber& number : numbers_of(material)) *number.value = number.in_range();
}

}  // namespace frontmost
