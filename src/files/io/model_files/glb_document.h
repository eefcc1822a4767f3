// SPDX-License-Identifier: Apache-2.0
// A glTF document while it is put together: JSON that names pieces of one buffer.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "frontmost/scene.h"

namespace frontmost::detail {

class GlbDocument {
 public:
  explicit GlbDocument(const Scene& scene) : scene_(scene) {}

  /// Everything but the buffer, which the file's second part is.
  nlohmann::ordered_json json = {{"asset", {{"version", "2.0"}, {"generator", "Frontmost"}}}};
  std::string buffer;

  /// Puts bytes at the buffer's end, from a multiple of four on. `target`: as glTF numbers what a view is for, or 0.
  /// \returns the number of the view.
  std::size_t add_view(const std::string& bytes, int target);
  /// \returns the number of the accessor.
  std::size_t add_accessor(nlohmann::ordered_json accessor, const std::string& bytes, int target);
  /// The number in the document of a texture of the scene, or of a material (no_index: the default one), which is put
  /// there when it is first asked for.
  std::size_t texture(std::uint32_t number);
  std::size_t material(std::uint32_t number);
  /// Says that an extension is used, and gives its name back.
  const char* uses(const char* extension) {
    extensions_.insert(extension);
    return extension;
  }
  [[nodiscard]] const std::set<std::string>& extensions() const { return extensions_; }

 private:
  const Scene& scene_;
  std::map<std::uint32_t, std::size_t> textures_, materials_;
  std::set<std::string> extensions_;
};

[[nodiscard]] nlohmann::ordered_json material_json(const Material& material, GlbDocument& document);

}  // namespace frontmost::detail
