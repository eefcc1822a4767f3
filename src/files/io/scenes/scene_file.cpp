// SPDX-License-Identifier: Apache-2.0
// Parses the text of scene files, and of files that assign categories to the objects of a scene. Names of categories
// and materials become numbers here, so that only models are left to be found.
//
// The pose of an object is given by rows, as in pose files of cameras, or by the parts that glTF and data sets use:
//
//   "pose": 16 or 12 numbers, or rows of four, or the name of a file that holds them
//   "translation": 3 numbers    "rotation": 4 (a quaternion x, y, z, w) or 9 (a matrix by rows)    "scale": 1 or 3
#include "io/scenes/scene_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/srgb.h"
#include "frontmost/files.h"
#include "io/input_file.h"
#include "io/models/gltf/json.h"
#include "io/models/gltf/nodes.h"
#include "io/models/mesh_building.h"
#include "io/models/text.h"

namespace frontmost {
namespace {

using gltf::JsonDocument;
using gltf::JsonValue;

/// Refuses objects with a repeated key. The JSON library silently drops all but the last value of a repeated key, so
/// the text is parsed once more, without keeping its values.
void refuse_repeated_keys(std::string_view text, const ModelSource& source) {
  struct Open {
    bool is_array;
    std::size_t values = 0;      ///< so far, in an array
    std::string key;             ///< the last key, in an object
    std::set<std::string> keys;  ///< all keys so far
  };
  std::vector<Open> open;
  // The place of the innermost object, written as JsonValue writes places.
  const auto place = [&] {
    std::string text_of_place;
    for (std::size_t i = 0; i + 1 < open.size(); ++i)
      text_of_place += open[i].is_array ? "[" + std::to_string(open[i].values - 1) + "]"
                                        : (text_of_place.empty() ? "" : ".") + printable(open[i].key);
    return text_of_place.empty() ? "JSON" : text_of_place;
  };
  using Event = nlohmann::json::parse_event_t;
  const auto check = [&](int, Event event, nlohmann::json& parsed) {
    if (event == Event::key) {
      const std::string key = parsed.get<std::string>();
      if (!open.back().keys.insert(key).second) source.fail(place(), in_quotes(key) + " is there twice");
      open.back().key = key;
      return true;
    }
    const bool starts = event == Event::object_start || event == Event::array_start;
    if ((starts || event == Event::value) && !open.empty()) ++open.back().values;
    if (starts) open.push_back({event == Event::array_start, 0, {}, {}});
    if (event == Event::object_end || event == Event::array_end) open.pop_back();
    return starts;
  };
  [[maybe_unused]] const nlohmann::json nothing = nlohmann::json::parse(text.begin(), text.end(), check);
}

/// Refuses unknown keys, which are mostly typing mistakes.
void check_keys(const JsonValue& object, std::initializer_list<std::string_view> known) {
  for (const std::string& key : object.keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string_view one : known) list += (list.empty() ? "" : ", ") + std::string(one);
    object.fail(in_quotes(key) + " is not known here; known are " + list);
  }
}

/// Reads "#rgb" or "#rrggbb".
glm::vec4 color_of_hex(const JsonValue& value) {
  const std::string text = value.to_string();
  const bool is_short = text.size() == 4;
  if (!text.starts_with('#') || !(is_short || text.size() == 7) ||
      !std::all_of(text.begin() + 1, text.end(), [](char c) { return hex_digit(c) >= 0; }))
    value.fail(in_quotes(text) + " is not a colour; expected #rgb, #rrggbb or three numbers from 0 to 1");
  glm::vec4 srgb(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const int byte =
        is_short ? 17 * hex_digit(text[1 + c]) : 16 * hex_digit(text[1 + 2 * c]) + hex_digit(text[2 + 2 * c]);
    srgb[int(c)] = float(byte) / 255.0f;
  }
  return linear_color(srgb);
}

/// Reads sRGB, as text or as three numbers. \returns linear light.
glm::vec3 read_color(const JsonValue& value) {
  if (value.is_string()) return glm::vec3(color_of_hex(value));
  double numbers[3];
  value.to_numbers(numbers);
  for (int c = 0; c < 3; ++c)
    if (!(numbers[c] >= 0 && numbers[c] <= 1)) value[std::size_t(c)].fail("the number is not between 0 and 1");
  return glm::vec3(linear_color(glm::vec4(float(numbers[0]), float(numbers[1]), float(numbers[2]), 1)));
}

/// Reads a number from 0 to 1. \returns `absent` if the key is absent.
float part_or(const JsonValue& material, const char* key, float absent) {
  const std::optional<JsonValue> value = material.find(key);
  if (!value) return absent;
  const double number = value->to_number();
  if (!(number >= 0 && number <= 1)) value->fail("the number is not between 0 and 1");
  return float(number);
}

/// Reads a material, which replaces materials of models.
Material read_look(const JsonValue& json, const std::string& name) {
  check_keys(json, {"color", "opacity", "metallic", "roughness", "emissive", "unlit", "double_sided"});
  Material material;
  material.name = name_of(name);
  if (const auto color = json.find("color")) material.base_color = glm::vec4(read_color(*color), 1);
  material.base_color.a = part_or(json, "opacity", 1);
  if (material.base_color.a < 1) material.alpha = Material::Alpha::blend;
  material.metallic = part_or(json, "metallic", material.metallic);
  material.roughness = part_or(json, "roughness", material.roughness);
  if (const auto color = json.find("emissive")) material.emissive = read_color(*color);
  material.unlit = json.bool_or("unlit", false);
  material.double_sided = json.bool_or("double_sided", false);
  return material;
}

/// Greatest number: beyond it, placed vertices do not fit into floats.
constexpr double largest = 1e30;

void append_number(const JsonValue& value, std::vector<double>& numbers) {
  const double number = value.to_number();
  if (!(std::abs(number) <= largest)) value.fail("the number is not between -1e30 and 1e30");
  numbers.push_back(number);
}

/// Returns the numbers of a list, or of a list of rows.
std::vector<double> numbers_in(const JsonValue& value) {
  constexpr std::size_t most = 16;
  std::vector<double> numbers;
  if (value.size() > most) value.fail("more than 16 numbers");
  for (std::size_t i = 0; i < value.size(); ++i) {
    const JsonValue row = value[i];
    if (row.is_number()) {
      append_number(row, numbers);
      continue;
    }
    if (row.size() > most) row.fail("more than 16 numbers");
    for (std::size_t k = 0; k < row.size(); ++k) append_number(row[k], numbers);
  }
  return numbers;
}

/// Returns the numbers in the file `name`, with any of the separators that pose files of cameras allow.
std::vector<double> numbers_in_file(const JsonValue& name) {
  constexpr std::uint64_t most_bytes = 1 << 16;
  constexpr std::string_view separators = " \t\r\n,;[]()";
  const InputFile file = name.source().open(name.to_string(), most_bytes);
  std::string_view text = text_of(file.bytes());
  std::vector<double> numbers;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(separators));
    double number = 0;
    const char* const end = word.data() + word.size();
    if (parse_double(word.data(), end, number) != end || !(std::abs(number) <= largest))
      name.fail(in_quotes(word) + " in that file is not a number between -1e30 and 1e30");
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

glm::dmat4 matrix_by_rows(const JsonValue& place, const std::vector<double>& numbers) {
  if (numbers.size() != 12 && numbers.size() != 16)
    place.fail(std::to_string(numbers.size()) + " numbers; a pose is 16 (or 12), row by row");
  glm::dmat4 matrix(1.0);
  for (std::size_t i = 0; i < numbers.size(); ++i) matrix[int(i % 4)][int(i / 4)] = numbers[i];
  for (int column = 0; column < 4; ++column)
    if (matrix[column][3] != (column == 3 ? 1 : 0)) place.fail("the last row is not 0 0 0 1");
  return matrix;
}

void refuse_singular(const JsonValue& place, const glm::dmat4& pose) {
  const double volume = glm::determinant(glm::dmat3(pose));
  if (!(std::abs(volume) > 0 && std::isfinite(volume))) place.fail("the pose is singular, or too large");
}

glm::dmat4 inverse_of(const JsonValue& place, const glm::dmat4& pose) {
  const glm::dmat3 turned = glm::inverse(glm::dmat3(pose));
  glm::dmat4 inverse(turned);
  inverse[3] = glm::dvec4(-(turned * glm::dvec3(pose[3])), 1);
  refuse_singular(place, inverse);
  if (!is_finite(glm::dvec3(inverse[3]))) place.fail("its inverse is too large");
  return inverse;
}

glm::dmat4 read_matrix(const JsonValue& object, const JsonValue& value) {
  const glm::dmat4 pose = matrix_by_rows(value, value.is_string() ? numbers_in_file(value) : numbers_in(value));
  refuse_singular(value, pose);
  const std::string convention = object.string_or_empty("pose_convention");
  if (convention.empty() || convention == "model-to-world") return pose;
  if (convention == "world-to-model") return inverse_of(value, pose);
  object.require("pose_convention").fail("must be model-to-world or world-to-model");
}

/// Returns the rotation that nine numbers give by rows. They must be orthonormal within the rounding errors of data
/// sets.
glm::dmat4 rotation_by_rows(const JsonValue& place, const std::vector<double>& numbers) {
  constexpr double tolerance = 1e-4;
  glm::dmat3 rotation;
  for (std::size_t i = 0; i < 9; ++i) rotation[int(i % 3)][int(i / 3)] = numbers[i];
  const glm::dmat3 square = glm::transpose(rotation) * rotation;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(square[i][k] - (i == k ? 1 : 0)) <= tolerance)) place.fail("is not a rotation");
  if (!(glm::determinant(rotation) > 0)) place.fail("mirrors; expected a rotation");
  return glm::dmat4(rotation);
}

glm::dmat4 read_rotation(const JsonValue& value) {
  const std::vector<double> numbers = numbers_in(value);
  if (numbers.size() == 9) return rotation_by_rows(value, numbers);
  if (numbers.size() != 4)
    value.fail(std::to_string(numbers.size()) + " numbers; a rotation is 4 (x, y, z, w) or 9, row by row");
  const glm::dvec4 quaternion(numbers[0], numbers[1], numbers[2], numbers[3]);
  const double length = glm::length(quaternion);
  if (!(length > 0 && std::isfinite(length))) value.fail("the quaternion is zero");
  return gltf::compose(glm::dvec3(0), quaternion, glm::dvec3(1));
}

/// Returns the pose of an object by "pose", or by "translation", "rotation" and "scale", or the identity if all are
/// absent.
glm::dmat4 read_pose(const JsonValue& object) {
  if (const std::optional<JsonValue> pose = object.find("pose")) {
    for (const char* const other : {"translation", "rotation", "scale"})
      if (object.find(other)) pose->fail(std::string("is given beside ") + other + "; give only one of them");
    return read_matrix(object, *pose);
  }
  if (const auto convention = object.find("pose_convention")) convention->fail("there is no pose");
  glm::dmat4 moved(1.0), scaled(1.0);
  if (const std::optional<JsonValue> value = object.find("translation")) {
    const std::vector<double> by = numbers_in(*value);
    if (by.size() != 3) value->fail("3 numbers are expected, not " + std::to_string(by.size()));
    moved[3] = {by[0], by[1], by[2], 1};
  }
  if (const std::optional<JsonValue> value = object.find("scale")) {
    std::vector<double> by;
    if (value->is_number())
      append_number(*value, by);
    else
      by = numbers_in(*value);
    if (by.size() == 1) by.resize(3, by[0]);
    if (by.size() != 3) value->fail("1 or 3 numbers are expected, not " + std::to_string(by.size()));
    for (int axis = 0; axis < 3; ++axis) scaled[axis][axis] = by[std::size_t(axis)];
    refuse_singular(*value, scaled);
  }
  const std::optional<JsonValue> rotation = object.find("rotation");
  return moved * (rotation ? read_rotation(*rotation) : glm::dmat4(1.0)) * scaled;
}

/// Reads a name for the scene. \throws Error file_malformed if the name is empty.
std::string read_name(const JsonValue& value) {
  std::string name = value.to_string();
  if (name.empty()) value.fail("the name is empty");
  return name_of(name);
}

/// Checks the length of a list. \throws Error limit_exceeded if it has more elements than a scene may have objects.
void check_count(const JsonValue& array) {
  if (array.size() > max_objects)
    array.source().fail_limit(array.place(),
                              std::to_string(array.size()) + " are more than " + std::to_string(max_objects));
}

Category read_category(const JsonValue& json, std::uint32_t number) {
  if (json.is_string()) return {read_name(json), number};
  check_keys(json, {"name", "number"});
  const std::optional<JsonValue> given = json.find("number");
  return {read_name(json.require("name")), given ? given->to_index(no_index) : number};
}

/// Categories by name. The names come from the file's list "categories" or, without such a list, from the names that
/// objects use.
class CategoryNames {
 public:
  /// Fills `categories`, which is borrowed. \throws Error file_malformed if a name or a number occurs twice.
  CategoryNames(const JsonValue& root, std::vector<Category>& categories) : categories_(categories) {
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

  /// Returns the index of a category. \throws Error file_malformed if the file has a list that lacks it.
  std::uint32_t get(const JsonValue& value) {
    const std::string name = read_name(value);
    const auto [found, is_new] = numbers_.emplace(name, std::uint32_t(categories_.size()));
    if (is_new && is_listed_) value.fail(in_quotes(name) + " is none of the file's categories");
    if (is_new) categories_.push_back({name, std::uint32_t(categories_.size() + 1)});
    return found->second;
  }

 private:
  std::vector<Category>& categories_;
  std::map<std::string, std::uint32_t> numbers_;  ///< index in `categories_`, by name
  bool is_listed_ = false;
};

Axis read_axis(const JsonValue& value) {
  constexpr std::pair<std::string_view, Axis> axes[] = {
      {"x", Axis::x},  {"y", Axis::y},        {"z", Axis::z},        {"+x", Axis::x},       {"+y", Axis::y},
      {"+z", Axis::z}, {"-x", Axis::minus_x}, {"-y", Axis::minus_y}, {"-z", Axis::minus_z},
  };
  const std::string text = value.to_string();
  for (const auto& [name, axis] : axes)
    if (text == name) return axis;
  value.fail(in_quotes(text) + " is not an axis; expected x, y, z, -x, -y or -z");
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
    if (!file.up) up->fail("the scene file has no up axis");
    object.up = read_axis(*up);
  }
  if (const auto unit = json.find("metres_per_unit")) {
    if (!file.metres_per_unit) unit->fail("the scene file has no unit");
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

void load_categories(std::span<const std::byte> bytes, const std::string& name, Scene& scene) {
  const ModelSource source(name, {});
  const JsonDocument document(text_of(bytes), source);
  refuse_repeated_keys(text_of(bytes), source);
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
  load_categories(InputFile::open_input(path, most_bytes).bytes(), input_name(path), scene);
}

}  // namespace frontmost
