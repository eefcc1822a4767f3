// SPDX-License-Identifier: Apache-2.0
// A glTF document under construction: JSON that names pieces of one buffer.
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

  /// The whole JSON part except the buffer, which is the file's second part.
  nlohmann::ordered_json json = {{"asset", {{"version", "2.0"}, {"generator", "Frontmost"}}}};
  std::string buffer;

  /// Appends bytes to the buffer, aligned to four. `target` is glTF's number for the use of the view, or 0. \returns
  /// the number of the view.
  std::size_t add_view(const std::string& bytes, int target);
  /// \returns the number of the accessor.
  std::size_t add_accessor(nlohmann::ordered_json accessor, const std::string& bytes, int target);
  /// The number in the document of the scene's texture or material `number` (no_index: the default material). The first
  /// request adds it to the document.
  std::size_t texture(std::uint32_t number);
  std::size_t material(std::uint32_t number);
  /// Notes that an extension is used. \returns its name.
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
