// SPDX-License-Identifier: Apache-2.0
// Materials of a glTF file.
#pragma once

#include "io/models/gltf/textures.h"

namespace frontmost::gltf {

/// Texture coordinate sets that are told apart; more than these hardly occur.
inline constexpr std::uint32_t max_texcoord_sets = 4;

struct MaterialList {
  std::vector<Material> materials;
  /// For each material, the set of texture coordinates that its textures use. A mesh has one: textures that ask for
  /// another than the base colour does are left out, with a warning.
  std::vector<std::uint32_t> texcoord_sets;
};

/// Names a material of the file in warnings: "materials[2] (lamp)".
[[nodiscard]] std::string described(const JsonValue& material);

[[nodiscard]] MaterialList read_materials(const JsonValue& root, TextureTable& textures,
                                          std::vector<std::string>& warnings);

}  // namespace frontmost::gltf
