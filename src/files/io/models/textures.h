// SPDX-License-Identifier: Apache-2.0
// Textures that a model names as files, for colours and for alpha. A file that cannot be read causes a warning, not an
// error. Also adapts materials whose texture cannot be used.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "io/models/reader.h"

namespace frontmost {

/// A budget of pixels. A file of 32 kB can hold an image of a gigabyte in one colour, but real images have some 1 to 30
/// pixels a byte. Each byte of an image file allows 64 pixels, and 8192 x 8192 more are free.
class PixelBudget {
 public:
  void add_file(std::uint64_t byte_count) { left_ += pixels_per_byte * byte_count; }
  /// Takes pixels from the budget. \returns false, without taking any, if they exceed the budget.
  [[nodiscard]] bool take(std::uint64_t pixels) {
    if (pixels > left_) return false;
    left_ -= pixels;
    return true;
  }

 private:
  static constexpr std::uint64_t pixels_per_byte = 64;
  std::uint64_t left_ = std::uint64_t(1) << 26;
};

/// The files of a texture. An empty name means that there is no such file.
struct TextureParts {
  std::string color = {};
  std::string alpha = {};  ///< if equal to `color`, the alpha of that file's own pixels
  Texture::Wrap wrap = Texture::Wrap::repeat;
};

struct MadeTexture {
  std::uint32_t texture = no_index;  ///< number in the scene; no_index if no file can be read
  bool has_color = false;            ///< whether the colour file was read; otherwise the texture is white
  /// Alpha mode that the alpha file needs: mask if all values are near 0 or 255, blend if some lie between.
  Material::Alpha alpha = Material::Alpha::opaque;
};

class TextureFiles {
 public:
  TextureFiles(const ModelSource& source, Scene& scene) : source_(source), scene_(scene) {}

  /// Returns the number of a texture in the scene. Files that cannot be read are left out, with a warning at `place`.
  MadeTexture get(const TextureParts& parts, const std::string& place);

 private:
  MadeTexture make(const TextureParts& parts, const std::string& place);
  std::optional<Texture> read(const std::string& reference, const std::string& place);
  [[nodiscard]] bool is_same_file(const std::string& a, const std::string& b) const;
  bool add_alpha(std::optional<Texture>& texture, Texture& alpha);

  const ModelSource& source_;
  Scene& scene_;
  PixelBudget budget_;
  std::set<std::filesystem::path> files_;  ///< files that added to the budget
  std::map<std::tuple<std::string, std::string, Texture::Wrap>, MadeTexture> known_;
};

// A factor is the greatest value of its texture, not a mean. If a texture says which parts glow or are metal, the
// factor without the texture would make all parts so.

/// Makes the material not glow. `who` names the material in the warning.
void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);
/// Makes the material a non-metal, as most are. Its roughness stays.
void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);

}  // namespace frontmost
