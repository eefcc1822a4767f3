// SPDX-License-Identifier: Apache-2.0
// Materials of a glTF file; and its textures: which images and samplers materials use, and their pixels.
//
//   material --> texture --> image    the same for many textures: decoded once
//                        --> sampler  how it wraps, and whether it is filtered
//
// A Texture of a scene has both pixels and wrapping, so a texture of the file stands for one pair of an image and a
// sampler's settings; equal pairs share a number.
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

  /// The number that a texture of the file will have in the scene; textures alike in image and sampler share one.
  /// lost_texture: it has no image that could be read, which `warnings` tells.
  [[nodiscard]] std::uint32_t intern(const JsonValue& index, std::vector<std::string>& warnings);

  /// Decodes in parallel and fills scene.textures. Images that cannot be decoded become warnings, and the materials go
  /// without them, as they do without a lost_texture.
  void load(Scene& scene) const;

 private:
  struct Look {
    std::uint32_t image = no_index;
    Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
    bool nearest = false;
    auto operator<=>(const Look&) const = default;
  };
  /// An encoded image, or where it is.
  struct Encoded {
    std::string place, name;
    Bytes bytes;
    std::vector<std::byte> decoded_uri;
    std::string path;  ///< of a file beside the model; empty: `bytes` holds the image
  };
  /// An image that textures use.
  struct Job {
    std::size_t uses = 0;  ///< textures that differ in their samplers, each of which gets the pixels
    Encoded encoded;
    Texture texture;
    std::string problem;  ///< why it cannot be decoded
  };
  struct Jobs {
    std::map<std::uint32_t, Job> by_image;
    std::map<std::uint32_t, std::uint32_t> first_alike;  ///< for every image the first one with the same bytes
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

/// Stands for a texture that cannot be used: TextureTable::load() does without it.
inline constexpr std::uint32_t lost_texture = no_index - 1;

/// Reads uses of textures, and notes which sets of coordinates they ask for.
class UseReader {
 public:
  UseReader(TextureTable& textures, std::vector<std::string>& warnings) : textures_(textures), warnings_(warnings) {}

  /// The use that is a member of `json`, if it is there; lost_texture where it cannot be used, which a warning tells.
  [[nodiscard]] TextureUse read(const JsonValue& json, const char* key);
  /// Bit k: set k is asked for.
  [[nodiscard]] std::uint32_t sets() const { return sets_; }

 private:
  TextureTable& textures_;
  std::vector<std::string>& warnings_;
  std::uint32_t sets_ = 0;
};

/// Reads what the extensions of a material say about its layers.
void read_layers(const JsonValue& json, UseReader& uses, Material& material);

struct MaterialList {
  std::vector<Material> materials;
  std::vector<std::uint32_t> texcoord_sets;  ///< for each material those that its textures use; bit k: set k
};

/// Names a material of the file in warnings: "materials[2] (lamp)".
[[nodiscard]] std::string described(const JsonValue& material);

[[nodiscard]] MaterialList read_materials(const JsonValue& root, TextureTable& textures,
                                          std::vector<std::string>& warnings);

}  // namespace frontmost::gltf
