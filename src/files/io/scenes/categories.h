// SPDX-License-Identifier: Apache-2.0
// Categories by name, as listed in scene files and category files, or as named by objects.
#pragma once

#include <map>

#include "frontmost/scene.h"
#include "io/models/gltf/json.h"

namespace frontmost {

/// Reads a name for the scene. \throws Error file_malformed if the name is empty.
[[nodiscard]] std::string read_name(const gltf::JsonValue& value);
/// \throws Error limit_exceeded if the list has more elements than a scene may have objects.
void check_count(const gltf::JsonValue& array);

/// Categories by name. The names come from the file's list "categories" or, without such a list, from the names that
/// objects use.
class CategoryNames {
 public:
  /// Fills `categories`, which is borrowed. \throws Error file_malformed if a name or a number occurs twice.
  CategoryNames(const gltf::JsonValue& root, std::vector<Category>& categories);

  /// The index of a category. \throws Error file_malformed if the file has a list that lacks it.
  [[nodiscard]] std::uint32_t get(const gltf::JsonValue& value);

 private:
  std::vector<Category>& categories_;
  std::map<std::string, std::uint32_t> numbers_;  ///< in the list
  bool is_listed_ = false;
};

}  // namespace frontmost
