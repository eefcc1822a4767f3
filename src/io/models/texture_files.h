// SPDX-License-Identifier: Apache-2.0
// Textures that a model names as files: each is read once, and what cannot be read is told, not fatal.
#pragma once

#include <map>
#include <tuple>

#include "io/models/pixel_budget.h"
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

}  // namespace frontmost
