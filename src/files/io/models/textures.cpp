// SPDX-License-Identifier: Apache-2.0
// Makes each texture once, however many materials name it. A model is worth showing without a texture, so each fault
// becomes a warning with its place and the reason.
#include "io/models/textures.h"

#include <algorithm>

#include "io/images/formats.h"
#include "io/models/reader.h"
#include "scene/texture_lookup.h"

namespace frontmost {
namespace {

constexpr std::uint64_t max_image_file_bytes = std::uint64_t(1) << 30;
constexpr std::size_t max_textures = 1 << 16;
constexpr const char* too_many_pixels = ": the textures together have too many pixels";

/// Sets the alpha of an image without alpha to its brightness.
void make_alpha(Texture& image) {
  if (std::any_of(image.pixels.begin(), image.pixels.end(), [](const glm::u8vec4& pixel) { return pixel.a != 255; }))
    return;
  for (glm::u8vec4& p : image.pixels) p.a = std::uint8_t((54 * p.r + 183 * p.g + 19 * p.b) / 256);
}

Material::Alpha alpha_mode(const Texture& image) {
  constexpr int noise = 15;  // deviation that JPEG leaves about 0 and 255
  auto mode = Material::Alpha::opaque;
  for (const glm::u8vec4& pixel : image.pixels) {
    if (pixel.a > noise && pixel.a < 255 - noise) return Material::Alpha::blend;
    if (pixel.a <= noise) mode = Material::Alpha::mask;
  }
  return mode;
}

/// Resizes bilinearly, as textures are looked up.
void resize(Texture& image, const glm::ivec2& size) {
  if (size == glm::ivec2(image.width, image.height)) return;
  std::vector<glm::u8vec4> pixels;
  pixels.reserve(std::size_t(size.x) * std::size_t(size.y));
  for (int i = 0; i < size.y; ++i) {
    const TexelPair y = texel_pair((float(i) + 0.5f) / float(size.y), image.height, image.wrap_v);
    const glm::u8vec4* above = &image.pixels[std::size_t(y.first) * std::size_t(image.width)];
    const glm::u8vec4* below = &image.pixels[std::size_t(y.second) * std::size_t(image.width)];
    for (int k = 0; k < size.x; ++k) {
      const TexelPair x = texel_pair((float(k) + 0.5f) / float(size.x), image.width, image.wrap_u);
      const auto mixed = [&](const glm::u8vec4* row) {
        return glm::mix(glm::vec4(row[x.first]), glm::vec4(row[x.second]), x.fraction);
      };
      pixels.emplace_back(glm::mix(mixed(above), mixed(below), y.fraction) + 0.5f);
    }
  }
  image.width = size.x;
  image.height = size.y;
  image.pixels = std::move(pixels);
}

}  // namespace

MadeTexture TextureFiles::get(const TextureParts& parts, const std::string& place) {
  if (known_.size() >= max_textures) return {};
  const auto [entry, is_new] = known_.try_emplace({parts.color, parts.alpha, parts.wrap});
  if (is_new) entry->second = make(parts, place);
  return entry->second;
}

/// Whether two names mean one file, as "wood.png" and "./wood.png" do.
bool TextureFiles::is_same_file(const std::string& a, const std::string& b) const {
  if (a == b) return true;
  if (a.empty() || b.empty() || !source_.has_folder()) return false;
  try {
    return source_.path_of(a) == source_.path_of(b);
  } catch (const Error&) {
    return false;  // reading the file reports the reason
  }
}

MadeTexture TextureFiles::make(const TextureParts& parts, const std::string& place) {
  MadeTexture made;
  std::optional<Texture> texture = read(parts.color, place);
  made.has_color = texture.has_value();
  if (texture) texture->wrap_u = texture->wrap_v = parts.wrap;
  if (is_same_file(parts.alpha, parts.color)) {
    if (texture) made.alpha = alpha_mode(*texture);
  } else if (std::optional<Texture> alpha = read(parts.alpha, place)) {
    alpha->wrap_u = alpha->wrap_v = parts.wrap;
    make_alpha(*alpha);
    made.alpha = alpha_mode(*alpha);
    if (made.alpha != Material::Alpha::opaque && !add_alpha(texture, *alpha)) {
      made.alpha = Material::Alpha::opaque;
      scene_.warnings.push_back(place + ": texture left out: " + printable(parts.alpha) + too_many_pixels);
    }
  }
  if (!texture) return made;
  made.texture = std::uint32_t(scene_.textures.size());
  scene_.textures.push_back(*std::move(texture));
  return made;
}

std::optional<Texture> TextureFiles::read(const std::string& reference, const std::string& place) {
  if (reference.empty()) return std::nullopt;
  if (!source_.has_folder()) {
    scene_.warnings.push_back(place + ": texture " + printable(reference) +
                              " is not read, because the model does not come from a file");
    return std::nullopt;
  }
  try {
    const InputFile file = source_.open(reference, max_image_file_bytes);
    const std::string name = source_.name() + ": " + printable(reference);
    const glm::ivec2 size = texture_size(file.bytes(), name, source_.image_decoder());
    // Each file adds to the budget once, although it may be part of many textures and have many names.
    if (files_.insert(source_.path_of(reference)).second) budget_.add_file(file.bytes().size());
    if (!budget_.take(std::uint64_t(size.x) * std::uint64_t(size.y)))
      throw Error(ErrorCode::limit_exceeded, name + too_many_pixels);
    Texture texture = decode_texture(file.bytes(), name, source_.image_decoder());
    texture.name = reference;
    return texture;
  } catch (const Error& error) {
    scene_.warnings.push_back(place + ": texture left out: " + source_.without_name(error));
    return std::nullopt;
  }
}

/// Gives the texture the alpha of another image. If there is no texture, it becomes white. Width and height become the
/// greater ones of the two images. \returns false, and changes nothing, if there are too many pixels.
bool TextureFiles::add_alpha(std::optional<Texture>& texture, Texture& alpha) {
  glm::ivec2 size(alpha.width, alpha.height);
  if (texture) size = glm::max(size, glm::ivec2(texture->width, texture->height));
  if (!budget_.take(std::uint64_t(size.x) * std::uint64_t(size.y))) return false;
  resize(alpha, size);
  if (texture) {
    resize(*texture, size);
    for (std::size_t i = 0; i < alpha.pixels.size(); ++i) texture->pixels[i].a = alpha.pixels[i].a;
  } else {
    for (glm::u8vec4& pixel : alpha.pixels) pixel = {255, 255, 255, pixel.a};
    texture = std::move(alpha);
  }
  return true;
}

void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings) {
  material.emissive_texture = {};
  if (material.emissive == glm::vec3(0)) return;
  material.emissive = glm::vec3(0);
  warnings.push_back(who + ": the emissive texture is missing, so the material does not glow");
}

void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings) {
  material.metallic_roughness_texture = {};
  if (material.metallic == 0) return;
  material.metallic = 0;
  warnings.push_back(who + ": its metallic-roughness texture is missing, so the material is not metallic");
}

}  // namespace frontmost
