// SPDX-License-Identifier: Apache-2.0
// Parses the text of a scene file. Names of categories and materials become numbers here, so that only models are left
// to be found.
#include "io/scenes/scene_file.h"

#include <algorithm>
#include <cmath>

#include "io/models/mesh_building.h"
#include "io/scenes/categories.h"

namespace frontmost {
namespace {

using gltf::JsonDocument;
using gltf::JsonValue;

Axis read_axis(const JsonValue& value) {
  constexpr std::pair<std::string_view, Axis> axes[] = {
      {"x", Axis::x},  {"y", Axis::y},        {"z", Axis::z},        {"+x", Axis::x},       {"+y", Axis::y},
      {"+z", Axis::z}, {"-x", Axis::minus_x}, {"-y", Axis::minus_y}, {"-z", Axis::minus_z},
  };
  const std::string text = value.to_string();
  for (const auto& [name, axis] : axes)
    if (text == name) return axis;
  value.fail(in_quotes(text) + " is not an axis; x, y, z, -x, -y and -z are");
}

double read_unit(const JsonValue& value) {
  const double metres = value.to_number();
  if (!(metres >= 1e-12 && metres <= 1e12)) value.fail("the number is not between 1e-12 and 1e12");
  return metres;
}

/// Materials by their names in the file.
class LookNames {
 public:
  LookNames(const JsonValue& root, std::vector<Material>& materials) {
    const std::optional<JsonValue> looks = root.find("materials");
    if (!looks) return;
    const std::vector<std::string> names = looks->keys();
    if (names.size() > max_objects) looks->source().fail_limit(looks->place(), "too many materials");
    for (const std::string& name : names) {
      numbers_.emplace(name, std::uint32_t(materials.size()));
      materials.push_back(read_look(looks->require(name.c_str()), name));
    }
  }

  /// Reads one name for the whole model, or an object that maps names of the model's materials to names of the file's.
  [[nodiscard]] Replacement read(const JsonValue& value) const {
    if (value.is_string()) return {get(value), {}};
    Replacement replacement;
    for (const std::string& name : value.keys())
      replacement.named.emplace(name_of(name), get(value.require(name.c_str())));
    return replacement;
  }

 private:
  [[nodiscard]] std::uint32_t get(const JsonValue& value) const {
    const std::string name = value.to_string();
    const auto found = numbers_.find(name);
    if (found == numbers_.end()) value.fail(in_quotes(name) + " is none of the file's materials");
    return found->second;
  }

  std::map<std::string, std::uint32_t> numbers_;
};

bool read_has_parts(const JsonValue& object) {
  const std::optional<JsonValue> value = object.find("parts");
  if (!value) return false;
  const std::string text = value->to_string();
  if (text != "together" && text != "apart")
    value->fail(in_quotes(text) + " is not allowed; expected \"together\" or \"apart\"");
  return text == "apart";
}

PlacedModel read_object(const JsonValue& json, const SceneFile& file, CategoryNames& categories,
                        const LookNames& looks) {
  check_keys(json, {"model", "name", "category", "pose", "pose_convention", "translation", "rotation", "scale", "up",
                    "metres_per_unit", "material", "parts"});
  PlacedModel object;
  object.place = json.place();
  object.model = json.require("model").to_string();
  if (const auto name = json.find("name")) object.name = read_name(*name);
  if (const auto category = json.find("category")) object.category = categories.get(*category);
  object.scene_from_model = read_pose(json);
  if (const auto up = json.find("up")) {
    if (!file.up) up->fail("the file does not say which way is up in the scene");
    object.up = read_axis(*up);
  }
  if (const auto unit = json.find("metres_per_unit")) {
    if (!file.metres_per_unit) unit->fail("the file does not say the unit of the scene");
    object.metres_per_unit = read_unit(*unit);
  }
  if (const auto material = json.find("material")) object.replacement = looks.read(*material);
  object.has_parts = read_has_parts(json);
  return object;
}

}  // namespace

SceneFile parse_scene_file(std::string_view text, const ModelSource& source) {
  const JsonDocument document(text, source);
  refuse_repeated_keys(text, source);
  const JsonValue root(document, source);
  check_keys(root, {"objects", "up", "metres_per_unit", "categories", "materials"});
  SceneFile file;
  if (const auto up = root.find("up")) file.up = read_axis(*up);
  if (const auto unit = root.find("metres_per_unit")) file.metres_per_unit = read_unit(*unit);
  CategoryNames categories(root, file.categories);
  const LookNames looks(root, file.materials);
  const JsonValue objects = root.require("objects");
  check_count(objects);
  for (std::size_t i = 0; i < objects.size(); ++i)
    file.objects.push_back(read_object(objects[i], file, categories, looks));
  return file;
}

}  // namespace frontmost
