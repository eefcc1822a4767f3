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

  /// The scene's number for a texture of the file; textures with equal image and sampler share one. Returns
  /// lost_texture, and adds a warning, if its image cannot be read.
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
  /// An encoded image, in memory or as a file's name.
  struct Encoded {
    std::string place, name;
    Bytes bytes;
    std::vector<std::byte> decoded_uri;
    std::string path;  ///< file beside the model; empty: `bytes` holds the image
  };
  /// An image that textures use.
  struct Job {
    std::size_t uses = 0;  ///< textures with different samplers, each of which gets the pixels
    Encoded encoded;
    Texture texture;
    std::string problem;  ///< the reason if it cannot be decoded
  };
  struct Jobs {
    std::map<std::uint32_t, Job> by_image;
    std::map<std::uint32_t, std::uint32_t> first_alike;  ///< for each image, the first one with the same bytes
  };

  void read_sampler(const JsonValue& texture, Look& look) const;
  [[nodiscard]] Encoded find_image(std::uint32_t image) const;
  template <class Use>
  auto with_bytes(const Encoded& encoded, Use use) const;
  [[nodiscard]] Jobs find_images() const;
  void check_sizes(Jobs& jobs) const;
  void decode(Jobs& jobs) const;

  const JsonValue& root_;
  const Data& data_;
  std::vector<Look> looks_;
  std::map<Look, std::uint32_t> numbers_;
};

/// Stands for a texture that cannot be used; TextureTable::load() removes its uses.
inline constexpr std::uint32_t lost_texture = no_index - 1;

/// Reads uses of textures and notes which sets of coordinates they need.
class UseReader {
 public:
  UseReader(TextureTable& textures, std::vector<std::string>& warnings) : textures_(textures), warnings_(warnings) {}

  /// The use in the member `key` of `json`; unset if absent. If it cannot be used, lost_texture with a warning.
  [[nodiscard]] TextureUse read(const JsonValue& json, const char* key);
  /// Bit k is set if set k is used.
  [[nodiscard]] std::uint32_t sets() const { return sets_; }

 private:
  TextureTable& textures_;
  std::vector<std::string>& warnings_;
  std::uint32_t sets_ = 0;
};

/// Reads the layers that a material's extensions describe.
void read_layers(const JsonValue& json, UseReader& uses, Material& material);

struct MaterialList {
  std::vector<Material> materials;
  std::vector<std::uint32_t> texcoord_sets;  ///< for each material, the sets that its textures use; bit k: set k
};

/// Describes a material of the file for warnings: "materials[2] (lamp)".
[[nodiscard]] std::string described(const JsonValue& material);

[[nodiscard]] MaterialList read_materials(const JsonValue& root, TextureTable& textures,
                                          std::vector<std::string>& warnings);

}  // namespace frontmost::gltf
