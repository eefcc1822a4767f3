// SPDX-License-Identifier: Apache-2.0
#include "io/models/gltf_textures.h"

#include "base/parallel.h"
#include "io/images/decode.h"
#include "io/models/gltf_uri.h"

namespace frontmost::gltf {
namespace {

/// Pixels of all images of a model: as many as one image may have, and more for larger files.
constexpr std::uint64_t pixels_per_byte = 64;
constexpr std::uint64_t max_image_bytes = std::uint64_t(1) << 30;

Texture::Wrap wrap_of(std::uint64_t code) {
  switch (code) {
    case 33071: return Texture::Wrap::clamp;
    case 33648: return Texture::Wrap::mirror;
    default: return Texture::Wrap::repeat;
  }
}
constexpr std::uint64_t repeat_code = 10497, nearest_code = 9728;

/// Warnings carry no file name.
std::string without_name(const std::string& message, const ModelSource& source) {
  const std::string prefix = source.name() + ": ";
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

void remap(TextureUse& use, const std::vector<std::uint32_t>& new_numbers) {
  if (!use.is_set()) return;
  use.texture = new_numbers[use.texture];
  if (!use.is_set()) use = TextureUse{};
}

}  // namespace

std::uint32_t TextureTable::intern(const Json& index, std::vector<std::string>& warnings) {
  const std::optional<Json> textures = root_.find("textures");
  const std::uint32_t id = index.to_index(textures ? textures->size() : 0);
  const Json texture = (*textures)[id];
  const std::optional<Json> images = root_.find("images");
  Look look;
  look.image = texture.index_or_none("source", images ? images->size() : 0);
  if (look.image == no_index) {
    warnings.push_back(texture.place() + ": has no PNG or JPEG image, materials go without it");
    return no_index;
  }
  read_sampler(texture, look);
  const auto [entry, is_new] = numbers_.emplace(look, std::uint32_t(looks_.size()));
  if (is_new) looks_.push_back(look);
  return entry->second;
}

void TextureTable::read_sampler(const Json& texture, Look& look) const {
  const std::optional<Json> samplers = root_.find("samplers");
  const std::uint32_t id = texture.index_or_none("sampler", samplers ? samplers->size() : 0);
  if (id == no_index) return;
  const Json sampler = (*samplers)[id];
  look.wrap_u = wrap_of(sampler.unsigned_or("wrapS", repeat_code));
  look.wrap_v = wrap_of(sampler.unsigned_or("wrapT", repeat_code));
  look.nearest = sampler.unsigned_or("magFilter", 0) == nearest_code;
}

TextureTable::Encoded TextureTable::find_image(std::uint32_t id) const {
  const Json image = root_.require("images")[id];
  Encoded encoded;
  encoded.name = image.name();
  encoded.place = image.place();
  const std::uint32_t view = image.index_or_none("bufferView", data_.view_count());
  if (view != no_index) {
    encoded.bytes = data_.view_bytes(view, image);
    return encoded;
  }
  const Json uri = image.require("uri");
  const std::string text = uri.to_string();
  if (is_data_uri(text)) {
    encoded.decoded_uri = decode_data_uri(text, uri);
    encoded.bytes = encoded.decoded_uri;
    return encoded;
  }
  encoded.path = percent_decode(text);
  encoded.place += " (" + printable(encoded.path) + ")";
  if (encoded.name.empty()) encoded.name = encoded.path;
  return encoded;
}

template <class Use>
auto TextureTable::with_bytes(const Encoded& encoded, Use use) const {
  if (encoded.path.empty()) return use(encoded.bytes, encoded.place);
  // Open only while it is used: a thousand images may name the same file.
  const InputFile file = root_.source().open(encoded.path, max_image_bytes);
  return use(file.bytes(), encoded.place);
}

std::map<std::uint32_t, Texture> TextureTable::decode_images(std::vector<std::string>& warnings) const {
  struct Job {
    std::uint32_t image = no_index;
    Encoded encoded;
    Texture texture;
    std::string problem;
  };
  std::map<std::uint32_t, Job> by_image;
  for (const Look& look : looks_) by_image[look.image].image = look.image;
  std::uint64_t pixels_left = max_image_pixels + pixels_per_byte * data_.byte_count();
  std::vector<Job*> jobs;
  for (auto& [id, job] : by_image) {
    try {
      job.encoded = find_image(id);
      const glm::ivec2 size = with_bytes(job.encoded, texture_size);
      const std::uint64_t pixels = std::uint64_t(size.x) * std::uint64_t(size.y);
      if (pixels > pixels_left)
        throw Error(ErrorCode::limit_exceeded, job.encoded.place + ": too many pixels in all images together");
      pixels_left -= pixels;
      jobs.push_back(&job);
    } catch (const Error& error) {
      job.problem = without_name(error.what(), root_.source());
    }
  }
  parallel_for(root_.source().execution(), jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Job& job = *jobs[i];
      try {
        job.texture = with_bytes(job.encoded, decode_texture);
        job.texture.name = job.encoded.name;
      } catch (const Error& error) {
        job.problem = without_name(error.what(), root_.source());
      }
    }
  });
  std::map<std::uint32_t, Texture> textures;
  for (auto& [id, job] : by_image) {
    if (job.problem.empty())
      textures.emplace(id, std::move(job.texture));
    else
      warnings.push_back(job.problem + "; materials go without it");
  }
  return textures;
}

void TextureTable::load(Scene& scene) const {
  std::map<std::uint32_t, Texture> images = decode_images(scene.warnings);
  std::map<std::uint32_t, std::size_t> uses_left;
  for (const Look& look : looks_) ++uses_left[look.image];
  std::vector<std::uint32_t> new_numbers(looks_.size(), no_index);
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Look& look = looks_[i];
    const auto image = images.find(look.image);
    if (image == images.end()) continue;
    new_numbers[i] = std::uint32_t(scene.textures.size());
    // Only samplers that differ make a second copy of the pixels.
    const bool last = --uses_left[look.image] == 0;
    Texture& texture = scene.textures.emplace_back(last ? std::move(image->second) : image->second);
    texture.wrap_u = look.wrap_u;
    texture.wrap_v = look.wrap_v;
    texture.nearest = look.nearest;
  }
  for (Material& material : scene.materials)
    for (TextureUse* use : {&material.base_color_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.emissive_texture, &material.occlusion_texture})
      remap(*use, new_numbers);
}

}  // namespace frontmost::gltf
