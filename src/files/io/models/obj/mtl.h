// SPDX-License-Identifier: Apache-2.0
// Materials of OBJ files: a table of names, filled from material libraries (MTL).
//
// Faces may name a material before its library is read, or without any library. So a name gets its number at its first
// use. Names that no library defines by the end cause a warning and remain plain materials.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "io/models/textures.h"

namespace frontmost {

/// The scene's materials by name. A name may be used before, after or without its definition.
class NamedMaterials {
 public:
  NamedMaterials(const ModelSource& source, Scene& scene) : source_(source), scene_(scene) {}

  /// Returns the number of the material called `name`. \throws Error limit_exceeded.
  std::uint32_t number(const std::string& name);
  /// Returns the number of the material called `name`, and marks the material as defined by a library. \throws Error
  /// limit_exceeded.
  std::uint32_t define(const std::string& name);
  [[nodiscard]] Material& operator[](std::uint32_t number) { return scene_.materials[number]; }
  [[nodiscard]] std::vector<std::string>& warnings() { return scene_.warnings; }
  /// Warns about names that no library defined.
  void finish();

 private:
  const ModelSource& source_;
  Scene& scene_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<bool> is_defined_;
};

/// Reads a material library. `library` names it in errors. `folder` is its folder, relative to the model. \throws Error
/// file_malformed.
void read_mtl(Bytes bytes, const ModelSource& library, const std::string& folder, TextureFiles& textures,
              NamedMaterials& materials);

}  // namespace frontmost
