// SPDX-License-Identifier: Apache-2.0
// Textures that a model names as files, for colours and for alpha. A file that cannot be read is told, not fatal. And
// what becomes of a material whose texture cannot be used.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "io/models/budget.h"
#include "io/models/reader.h"

namespace frontmost {

/// The files that a texture is made of. An empty name: there is no such file.
struct TextureParts {
  std::string color = {};
  std::string alpha = {};  ///< the name of the colour file: the alpha of its own pixels
  Texture::Wrap wrap = Texture::Wrap::repeat;
};

struct MadeTexture {
  std::uint32_t texture = no_index;  ///< in the scene; no_index where no file can be read
  bool has_color = false;            ///< the colour file was read; without it the texture is white
  /// What the alpha file needs: mask where all values are near 0 or 255, blend where some lie between.
  Material::Alpha alpha = Material::Alpha::opaque;
};

class TextureFiles {
 public:
  TextureFiles(const ModelSource& source, Scene& scene) : source_(source), scene_(scene) {}

  /// A texture of the scene. Files that cannot be read are left out, with a warning at `place`.
  MadeTexture get(const TextureParts& parts, const std::string& place);

 private:
  MadeTexture make(const TextureParts& parts, const std::string& place);
  std::optional<Texture> read(const std::string& reference, const std::string& place);
  [[nodiscard]] bool is_same_file(const std::string& a, const std::string& b) const;
  bool add_alpha(std::optional<Texture>& texture, Texture& alpha);

  const ModelSource& source_;
  Scene& scene_;
  PixelBudget budget_;
  std::set<std::filesystem::path> files_;  ///< those that added to the budget
  std::map<std::tuple<std::string, std::string, Texture::Wrap>, MadeTexture> known_;
};

// A factor is the greatest value that its texture allows, not a mean: where the texture says which parts glow or are of
// metal, the factor alone would make all of them so.

/// The material does not glow. `who` names it in the warning.
void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);
/// The material is no metal, as most that are seen. Its roughness stays.
void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);

}  // namespace frontmost
