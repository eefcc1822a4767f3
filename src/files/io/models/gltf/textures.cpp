// SPDX-License-Identifier: Apache-2.0
// Each image is decoded once, in parallel, although many textures may use it with other samplers. Images that name the
// same bytes or the same file count as one, because some exporters write an image for each material.
//
// Textures get their numbers before it is known which images can be decoded; load() closes the gaps afterwards.
#include "io/models/textures.h"

#include "base/parallel.h"
#include "io/images/formats.h"
#include "io/models/gltf/data.h"
#include "io/models/gltf/materials.h"

namespace frontmost::gltf {
namespace {

constexpr std::uint64_t max_image_bytes = std::uint64_t(1) << 30;

Texture::Wrap wrap_of(std::uint64_t code) {
  switch (code) {
    case 33071: return Texture::Wrap::clamp;
    case 33648: return Texture::Wrap::mirror;
    default: return Texture::Wrap::repeat;
  }
}
constexpr std::uint64_t repeat_code = 10497, nearest_code = 9728;

/// Returns the text of a warning about a texture without an image that can be read.
std::string lack_of_image(const JsonValue& texture) {
  if (texture.extension("KHR_texture_basisu")) {
    const auto advice = conversion_of_extensions({"KHR_texture_basisu"}, texture.source().name());
    return ": its image is KTX2, which is not read (" + advice.value_or("") + ")";
  }
  if (texture.extension("EXT_texture_webp")) return ": its image is WebP, and this Frontmost was built without libwebp";
  return ": has no PNG, JPEG or WebP image";
}

/// Replaces the number of a texture by its new one. \returns false if the texture is lost.
bool remap(TextureUse& use, const std::vector<std::uint32_t>& new_numbers) {
  if (!use.is_set()) return true;
  use.texture = use.texture == lost_texture ? no_index : new_numbers[use.texture];
  if (use.is_set()) return true;
  use = TextureUse{};
  return false;
}

/// Changes a material whose texture is lost. Without its texture a factor would not mean what the file says, so the
/// layer is removed. Textures that only add colour or bumps are just left out.
void do_without(const TextureUse* lost, Material& m, const std::string& who, std::vector<std::string>& warnings) {
  if (lost == &m.metallic_roughness_texture) return lose_metallic_roughness_texture(m, who, warnings);
  if (lost == &m.emissive_texture) return lose_emissive_texture(m, who, warnings);
  const auto lose = [&](auto& layer, const char* name) {
    layer = {};
    warnings.push_back(who + ": has no " + name + " without its texture");
  };
  if (lost == &m.specular.factor_texture || lost == &m.specular.color_texture) {
    lose(m.specular, "specular layer");
    if (m.ior == 0) m.ior = Material{}.ior;  // the mirror has its colour from that layer alone
  }
  if (lost == &m.clearcoat.factor_texture || lost == &m.clearcoat.roughness_texture) lose(m.clearcoat, "clearcoat");
  if (lost == &m.sheen.color_texture || lost == &m.sheen.roughness_texture) lose(m.sheen, "sheen");
  if (lost == &m.transmission.factor_texture) lose(m.transmission, "transmission");
  if (lost == &m.volume.thickness_texture) lose(m.volume, "volume");
}

}  // namespace

std::uint32_t TextureTable::intern(const JsonValue& index, std::vector<std::string>& warnings) {
  const std::uint32_t id = index.to_index(root_.count("textures"));
  const JsonValue texture = root_.require("textures")[id];
  const std::size_t image_count = root_.count("images");
  Look look;
  // WebP has precedence: the texture's plain source is for programs without the extension.
  if (const auto webp = texture.extension("EXT_texture_webp"); webp && decodes_webp(root_.source().image_decoder()))
    look.image = webp->require("source").to_index(image_count);
  else
    look.image = texture.index_or_none("source", image_count);
  if (look.image == no_index) {
    warnings.push_back(texture.place() + lack_of_image(texture) + ", materials go without it");
    return lost_texture;
  }
  read_sampler(texture, look);
  const auto [entry, is_new] = numbers_.emplace(look, std::uint32_t(looks_.size()));
  // The number is an index of looks_, because it is unknown yet which images can be decoded; load() closes the gaps.
  if (is_new) looks_.push_back(look);
  return entry->second;
}

void TextureTable::read_sampler(const JsonValue& texture, Look& look) const {
  const std::uint32_t id = texture.index_or_none("sampler", root_.count("samplers"));
  if (id == no_index) return;
  const JsonValue sampler = root_.require("samplers")[id];
  look.wrap_u = wrap_of(sampler.unsigned_or("wrapS", repeat_code));
  look.wrap_v = wrap_of(sampler.unsigned_or("wrapT", repeat_code));
  look.nearest = sampler.unsigned_or("magFilter", 0) == nearest_code;
}

/// Finds and decodes the images that textures use.
class TextureTable::ImageLoader {
  /// An encoded image, in memory or as a file's name.
  struct Encoded {
    std::string place, name;
    Bytes bytes;
    std::vector<std::byte> decoded_uri;
    std::string path;  ///< file beside the model; empty: `bytes` holds the image
  };

  [[nodiscard]] Encoded find_image(std::uint32_t id) const {
    const JsonValue image = root_.require("images")[id];
    Encoded encoded;
    encoded.name = image.name();
    encoded.place = image.place();
    const std::uint32_t view = image.index_or_none("bufferView", data_.view_count());
    if (view != no_index) {
      encoded.bytes = data_.view_bytes(view, image);
      return encoded;
    }
    const JsonValue uri = image.require("uri");
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
  auto with_bytes(const Encoded& encoded, Use use) const {
    if (encoded.path.empty()) return use(encoded.bytes, encoded.place);
    // The file is open only while it is used, because a thousand images may name the same file.
    const InputFile file = root_.source().open(encoded.path, max_image_bytes);
    return use(file.bytes(), encoded.place);
  }

 public:
  /// An image that textures use.
  struct Job {
    std::size_t uses = 0;  ///< textures with different samplers, each of which gets the pixels
    Encoded encoded;
    Texture texture;
    std::string problem;  ///< the reason if it cannot be decoded
  };

  ImageLoader(const JsonValue& root, const Data& data) : root_(root), data_(data) {}

  /// Finds the images of textures. Images that name the same bytes or file are decoded once: some exporters write an
  /// image for each material, and hostile files write thousands.
  void find(const std::vector<Look>& looks) {
    std::map<std::tuple<const std::byte*, std::size_t, std::string>, std::uint32_t> places;
    for (const Look& look : looks) {
      const auto [alike, is_new] = first_alike_.emplace(look.image, look.image);
      if (is_new) {
        Job job;
        try {
          job.encoded = find_image(look.image);
          const auto [place, is_first] =
              places.try_emplace({job.encoded.bytes.data(), job.encoded.bytes.size(), job.encoded.path}, look.image);
          alike->second = place->second;
        } catch (const Error& error) {
          job.problem = root_.source().without_name(error);
        }
        if (alike->second == look.image) by_image_.emplace(look.image, std::move(job));
      }
      ++by_image_.at(alike->second).uses;
    }
  }

  /// Reads the images' headers. Images that exceed the budget get a problem, before memory is allocated.
  void check_sizes() {
    // Buffer views may overlap, and scanning an image's chunks takes time, so each byte may belong to a few images
    // only.
    std::uint64_t encoded_left = (std::uint64_t(1) << 24) + 4 * data_.byte_count();
    PixelBudget budget;
    budget.add_file(data_.byte_count());
    for (auto& entry : by_image_) {
      Job& job = entry.second;  // a named reference, because lambdas may not capture structured bindings
      if (!job.problem.empty()) continue;
      const std::string& place = job.encoded.place;
      try {
        if (job.encoded.bytes.size() > encoded_left)
          throw Error(ErrorCode::limit_exceeded, place, "all images together are larger than the file");
        encoded_left -= job.encoded.bytes.size();
        const auto pixel_count = [&](Bytes bytes, const std::string& name) {
          if (!job.encoded.path.empty()) budget.add_file(bytes.size());
          const glm::ivec2 size = texture_size(bytes, name, root_.source().image_decoder());
          return std::uint64_t(size.x) * std::uint64_t(size.y);
        };
        if (!budget.take(job.uses * with_bytes(job.encoded, pixel_count)))
          throw Error(ErrorCode::limit_exceeded, place, "too many pixels in all images together");
      } catch (const Error& error) {
        job.problem = root_.source().without_name(error);
      }
    }
  }

  void decode() {
    std::vector<Job*> list;
    for (auto& [id, job] : by_image_)
      if (job.problem.empty()) list.push_back(&job);
    parallel_for(root_.source().execution(), list.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Job& job = *list[i];
        try {
          job.texture = with_bytes(job.encoded, [&](Bytes bytes, const std::string& name) {
            return decode_texture(bytes, name, root_.source().image_decoder());
          });
          job.texture.name = job.encoded.name;
        } catch (const Error& error) {
          job.problem = root_.source().without_name(error);
        }
      }
    });
  }

  [[nodiscard]] const std::map<std::uint32_t, Job>& jobs() const { return by_image_; }
  [[nodiscard]] Job& job_of(std::uint32_t image) { return by_image_.at(first_alike_.at(image)); }

 private:
  const JsonValue& root_;
  const Data& data_;
  std::map<std::uint32_t, Job> by_image_;
  std::map<std::uint32_t, std::uint32_t> first_alike_;  ///< for each image, the first one that names the same bytes or
                                                        ///< file
};

void TextureTable::load(Scene& scene) const {
  ImageLoader images(root_, data_);
  images.find(looks_);
  images.check_sizes();
  images.decode();
  for (const auto& [id, job] : images.jobs())
    if (!job.problem.empty()) scene.warnings.push_back(job.problem + "; materials go without it");
  std::vector<std::uint32_t> new_numbers(looks_.size(), no_index);
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Look& look = looks_[i];
    ImageLoader::Job& job = images.job_of(look.image);
    if (!job.problem.empty()) continue;
    new_numbers[i] = std::uint32_t(scene.textures.size());
    // The pixels are copied only for a further sampler of the same image.
    const bool last = --job.uses == 0;
    Texture& texture = scene.textures.emplace_back(last ? std::move(job.texture) : job.texture);
    texture.wrap_u = look.wrap_u;
    texture.wrap_v = look.wrap_v;
    texture.nearest = look.nearest;
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& material = scene.materials[i];
    for (TextureUse* use : texture_uses_of(material))
      if (!remap(*use, new_numbers))
        do_without(use, material, described(root_.require("materials")[i]), scene.warnings);
  }
}

}  // namespace frontmost::gltf
