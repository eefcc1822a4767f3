// SPDX-License-Identifier: Apache-2.0
// Categories of a scene file, and of separate files that assign categories to the objects of a scene.
#include "io/scenes/categories.h"

#include <set>

#include "frontmost/files.h"
#include "io/input_file.h"
#include "io/models/mesh_building.h"
#include "io/scenes/scene_file.h"

namespace frontmost {

using gltf::JsonDocument;
using gltf::JsonValue;

std::string read_name(const JsonValue& value) {
  std::string name = value.to_string();
  if (name.empty()) value.fail("the name is empty");
  return name_of(name);
}

void check_count(const JsonValue& array) {
  if (array.size() > max_objects)
    array.source().fail_limit(array.place(),
                              std::to_string(array.size()) + " are more than " + std::to_string(max_objects));
}

namespace {

Category read_category(const JsonValue& json, std::uint32_t number) {
  if (json.is_string()) return {read_name(json), number};
  check_keys(json, {"name", "number"});
  const std::optional<JsonValue> given = json.find("number");
  return {read_name(json.require("name")), given ? given->to_index(no_index) : number};
}

}  // namespace

CategoryNames::CategoryNames(const JsonValue& root, std::vector<Category>& categories) : categories_(categories) {
  const std::optional<JsonValue> list = root.find("categories");
  is_listed_ = list.has_value();
  if (!list) return;
  check_count(*list);
  std::set<std::uint32_t> numbers;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const JsonValue json = (*list)[i];
    const Category category = read_category(json, std::uint32_t(i + 1));
    if (!numbers_.emplace(category.name, std::uint32_t(i)).second) json.fail("the name is there twice");
    if (!numbers.insert(category.number).second) json.fail("the number is there twice");
    categories_.push_back(category);
  }
}

std::uint32_t CategoryNames::get(const JsonValue& value) {
  const std::string name = read_name(value);
  const auto [found, is_new] = numbers_.emplace(name, std::uint32_t(categories_.size()));
  if (is_new && is_listed_) value.fail(in_quotes(name) + " is none of the file's categories");
  if (is_new) categories_.push_back({name, std::uint32_t(categories_.size() + 1)});
  return found->second;
}

void load_categories(std::span<const std::byte> bytes, const std::string& name, Scene& scene) {
  const ModelSource source(name, {});
  const std::string_view text = text_of(bytes);
  const JsonDocument document(text, source);
  refuse_repeated_keys(text, source);
  const JsonValue root(document, source);
  check_keys(root, {"categories", "objects"});
  std::vector<Category> categories;
  CategoryNames names(root, categories);
  const JsonValue objects = root.require("objects");
  std::map<std::string, std::uint32_t> of_object;
  for (const std::string& object : objects.keys())
    of_object.emplace(name_of(object), names.get(objects.require(object.c_str())));
  std::set<std::string_view> is_there;
  for (Instance& instance : scene.instances) {
    const auto found = of_object.find(instance.name);
    instance.category = found == of_object.end() ? no_index : found->second;
    if (found != of_object.end()) is_there.insert(found->first);
  }
  for (const auto& [object, category] : of_object)
    if (!is_there.contains(object))
      scene.warnings.push_back(source.with_name("objects: no object has the name " + in_quotes(object)));
  scene.categories = std::move(categories);
}

void load_categories(const std::string& path, Scene& scene) {
  constexpr std::uint64_t most_bytes = std::uint64_t(1) << 26;
  const bool is_input = path == "-";
  const InputFile file =
      is_input ? InputFile::standard_input("standard input", most_bytes) : InputFile::open(path, path, most_bytes);
  load_categories(file.bytes(), is_input ? "standard input" : path, scene);
}

}  // namespace frontmost
