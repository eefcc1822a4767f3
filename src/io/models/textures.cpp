// SPDX-License-Identifier: Apache-2.0
// Each texture is read once, however many materials name it. A model is worth showing without a texture, so whatever is
// wrong with one becomes a warning that says where it is named and why it was left out.
#include "io/models/textures.h"

#include "io/images/decode.h"
#include "io/models/model_source.h"

namespace frontmost {
namespace {
constexpr std::uint64_t max_image_file_bytes = std::uint64_t(1) << 30;
constexpr std::size_t max_textures = 1 << 16;
}  // namespace

std::uint32_t TextureFiles::get(const std::string& reference, const std::string& place, Texture::Wrap wrap) {
  if (known_.size() >= max_textures) return no_index;
  const auto [entry, is_new] = known_.try_emplace({reference, wrap}, no_index);
  if (is_new) entry->second = read(reference, place, wrap);
  return entry->second;
}

std::uint32_t TextureFiles::read(const std::string& reference, const std::string& place, Texture::Wrap wrap) {
  if (!source_.has_folder()) {
    scene_.warnings.push_back(place + ": texture " + printable(reference) +
                              " is not read, the model does not come from a file");
    return no_index;
  }
  try {
    const InputFile file = source_.open(reference, max_image_file_bytes);
    const std::string name = source_.name() + ": " + printable(reference);
    const glm::ivec2 size = texture_size(file.bytes(), name, source_.image_decoder());
    budget_.add_file(file.bytes().size());
    if (!budget_.take(std::uint64_t(size.x) * std::uint64_t(size.y)))
      throw Error(ErrorCode::limit_exceeded, name + ": the textures together have too many pixels");
    Texture texture = decode_texture(file.bytes(), name, source_.image_decoder());
    texture.name = reference;
    texture.wrap_u = texture.wrap_v = wrap;
    scene_.textures.push_back(std::move(texture));
  } catch (const Error& error) {
    scene_.warnings.push_back(place + ": texture left out: " + source_.without_name(error));
    return no_index;
  }
  return std::uint32_t(scene_.textures.size() - 1);
}

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
