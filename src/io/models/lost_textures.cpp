// SPDX-License-Identifier: Apache-2.0
#include "io/models/lost_textures.h"

namespace frontmost {

void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings) {
  material.emissive_texture = {};
  if (material.emissive == glm::vec3(0)) return;
  material.emissive = glm::vec3(0);
  warnings.push_back(who + ": does not glow without its emissive texture");
}

void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings) {
  material.metallic_roughness_texture = {};
  if (material.metallic == 0) return;
  material.metallic = 0;
  warnings.push_back(who + ": is no metal without its metallic-roughness texture");
}

}  // namespace frontmost
