// SPDX-License-Identifier: Apache-2.0
// Materials and textures of a glTF file: the images and samplers that materials use, and their pixels.
//
//   material --> texture --> image    many textures may share one, which is decoded once
//                        --> sampler  how it wraps, and whether it is filtered
//
// A scene's Texture has both pixels and wrapping, so it stands for a pair of an image and a sampler's settings. Equal
// pairs share a number.
#pragma once

#include <map>
#include <tuple>

#include "frontmost/scene.h"
#include "io/models/gltf/data.h"

namespace frontmost::gltf {

/// Collects the textures that materials name, then decodes each image once.
class TextureTable {
 public:
  TextureTable(const JsonValue& root, const Data& data) : root_(root), data_(data) {}

  /// Returns the scene's number for a texture of the file. Textures with equal image and sampler share one. Returns
  /// lost_texture, and adds a warning, if the image cannot be read.
  [[nodiscard]] std::uint32_t intern(const JsonValue& index, std::vector<std::string>& warnings);

  /// Decodes in parallel and fills scene.textures. Images that cannot be decoded cause warnings, and their materials do
  /// without them, as with lost_texture.
  void load(Scene& scene) const;

 private:
  struct Look {
    std::uint32_t image = no_index;
    Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
    bool nearest = false;
    auto operator<=>(const Look&) const = default;
  };
  class ImageLoader;
  void read_sampler(const JsonValue& texture, Look& look) const;

  const JsonValue& root_;
  const Data& data_;
  std::vector<Look> looks_;
  std::map<Look, std::uint32_t> numbers_;
};

/// Stands for a texture that cannot be used; TextureTable::load() removes its uses.
inline constexpr std::uint32_t lost_texture = no_index - 1;

struct MaterialList {
  std::vector<Material> materials;
  std::vector<std::uint32_t> texcoord_sets;  ///< for each material, the sets that its textures use; bit k: set k
};

/// Describes a material of the file for warnings: "materials[2] (lamp)".
[[nodiscard]] std::string described(const JsonValue& material);

[[nodiscard]] MaterialList read_materials(const JsonValue& root, TextureTable& textures,
                                          std::vector<std::string>& warnings);

}  // namespace frontmost::gltf
