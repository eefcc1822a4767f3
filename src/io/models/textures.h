// SPDX-License-Identifier: Apache-2.0
// Textures that a model names as files: each is read once, and what cannot be read is told, not fatal. And what becomes
// of a material whose texture cannot be used.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/models/budget.h"
#include "io/models/reader.h"

namespace frontmost {

class TextureFiles {
 public:
  TextureFiles(const ModelSource& source, Scene& scene) : source_(source), scene_(scene) {}

  /// The number of the texture in the scene; no_index where it cannot be read, with a warning at `place`.
  std::uint32_t get(const std::string& reference, const std::string& place, Texture::Wrap wrap = Texture::Wrap::repeat);

 private:
  std::uint32_t read(const std::string& reference, const std::string& place, Texture::Wrap wrap);

  const ModelSource& source_;
  Scene& scene_;
  PixelBudget budget_;
  std::map<std::pair<std::string, Texture::Wrap>, std::uint32_t> known_;
};

// A factor is the greatest value that its texture allows, not a mean: where the texture says which parts glow or are of
// metal, the factor alone would make all of them so.

/// The material does not glow. `who` names it in the warning.
void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);
/// The material is no metal, as most that are seen. Its roughness stays.
void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);

}  // namespace frontmost
