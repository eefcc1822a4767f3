// SPDX-License-Identifier: Apache-2.0
// Categories by name, as scene files and files of categories list them, or as objects name them.
#pragma once

#include <map>

#include "frontmost/scene.h"
#include "io/models/gltf/json.h"

namespace frontmost {

/// A name of the file for the scene. \throws Error file_malformed where it is empty.
[[nodiscard]] std::string read_name(const gltf::JsonValue& value);
/// \throws Error limit_exceeded for a list of more elements than a scene may have objects.
void check_count(const gltf::JsonValue& array);

/// Categories by name: those of the list "categories" of the file, or, without one, as objects name them.
class CategoryNames {
 public:
  /// Fills `categories`, which is borrowed. \throws Error file_malformed for a name or a number that is there twice.
  CategoryNames(const gltf::JsonValue& root, std::vector<Category>& categories);

  /// Its place among the categories. \throws Error file_malformed where there is a list without it.
  [[nodiscard]] std::uint32_t get(const gltf::JsonValue& value);

 private:
  std::vector<Category>& categories_;
  std::map<std::string, std::uint32_t> numbers_;  ///< in the list
  bool is_listed_ = false;
};

}  // namespace frontmost
