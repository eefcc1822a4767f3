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
  /// no_index: it has no image that could be read, which `warnings` tells.
  [[nodiscard]] std::uint32_t intern(const JsonValue& index, std::vector<std::string>& warnings);

  /// Decodes in parallel and fills scene.textures. Images that cannot be decoded become warnings, and the materials go
  /// without them.
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
