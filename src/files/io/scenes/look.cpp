// SPDX-License-Identifier: Apache-2.0
// Materials of a scene file, which replace those of models: colours in hexadecimal or as numbers, and glTF's factors.
#include <cmath>

#include "base/srgb.h"
#include "io/models/mesh_building.h"
#include "io/scenes/scene_file.h"

namespace frontmost {
namespace {

using gltf::JsonValue;

/// Reads "#rgb" or "#rrggbb".
glm::vec4 color_of_hex(const JsonValue& value) {
  const std::string text = value.to_string();
  const auto digit = [&](std::size_t i) -> int {
    const char c = text[i];
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    value.fail(in_quotes(text) + " is not a colour; expected #rgb, #rrggbb or three numbers from 0 to 1");
  };
  if (!text.starts_with('#') || (text.size() != 4 && text.size() != 7))
    value.fail(in_quotes(text) + " is not a colour; expected #rgb, #rrggbb or three numbers from 0 to 1");
  glm::vec4 srgb(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const int byte = text.size() == 4 ? 17 * digit(1 + c) : 16 * digit(1 + 2 * c) + digit(2 + 2 * c);
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

}  // namespace

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

}  // namespace frontmost
