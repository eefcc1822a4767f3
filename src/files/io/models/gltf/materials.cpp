// SPDX-License-Identifier: Apache-2.0
// Reads the materials: metallic-roughness here, layers of extensions in material_layers.cpp. Textures that cannot be
// used keep a mark, so that TextureTable::load() knows which materials have to do without them.
#include "io/models/gltf/materials.h"

#include <algorithm>

#include "scene/material.h"

namespace frontmost::gltf {
namespace {

/// Reads one material.
class MaterialReader {
 public:
  MaterialReader(UseReader& uses, std::vector<std::string>& warnings) : uses_(uses), warnings_(warnings) {}

  Material read(const JsonValue& json) {
    Material material;
    material.name = json.name();
    // glTF's defaults, which differ from those of Material.
    material.metallic = material.roughness = 1;
    if (const auto pbr = json.find("pbrMetallicRoughness")) read_metallic_roughness(*pbr, material);
    material.normal_texture = uses_.read(json, "normalTexture");
    if (const auto normal = json.find("normalTexture")) material.normal_scale = float(normal->number_or("scale", 1));
    material.occlusion_texture = uses_.read(json, "occlusionTexture");
    if (const auto occlusion = json.find("occlusionTexture"))
      material.occlusion_strength = float(occlusion->number_or("strength", 1));
    read_emissive(json, material);
    read_alpha(json, material);
    material.double_sided = json.bool_or("doubleSided", false);
    material.unlit = json.extension("KHR_materials_unlit").has_value();
    read_layers(json, uses_, material);
    bring_into_range(json, material);
    warn_if_black_without_iridescence(json, material);
    return material;
  }

 private:
  void bring_into_range(const JsonValue& json, Material& material) {
    std::string_view told;  // all channels of a colour have one name
    for (const MaterialNumber& number : numbers_of(material)) {
      if (*number.value == number.in_range()) continue;
      if (number.name != told)
        warnings_.push_back(described(json) + ": " + number.name + " is out of range, the nearest in range counts");
      told = number.name;
      *number.value = number.in_range();
    }
  }

  /// Warns about thin films such as soap bubbles or beetles, whose colour is lost because the base is black.
  void warn_if_black_without_iridescence(const JsonValue& json, const Material& m) {
    constexpr float black = 0.02f;  // sRGB 38 of 255
    const auto iridescence = json.extension("KHR_materials_iridescence");
    if (!iridescence || iridescence->number_or("iridescenceFactor", 0) <= 0) return;
    const glm::vec3 shown = glm::max(glm::vec3(m.base_color), glm::max(m.emissive, m.sheen.color));
    if (std::max({shown.r, shown.g, shown.b}) > black || m.transmission.factor > 0) return;
    warnings_.push_back(described(json) +
                        ": is drawn black: its colours are those of KHR_materials_iridescence, which is not read");
  }

  void read_metallic_roughness(const JsonValue& json, Material& material) {
    double color[4];
    if (json.read_numbers("baseColorFactor", color))
      for (int c = 0; c < 4; ++c) material.base_color[c] = float(color[c]);
    material.metallic = float(json.number_or("metallicFactor", 1));
    material.roughness = float(json.number_or("roughnessFactor", 1));
    material.base_color_texture = uses_.read(json, "baseColorTexture");
    material.metallic_roughness_texture = uses_.read(json, "metallicRoughnessTexture");
  }

  void read_emissive(const JsonValue& json, Material& material) {
    double color[3];
    const auto strength = json.extension("KHR_materials_emissive_strength");
    const double factor = strength ? strength->number_or("emissiveStrength", 1) : 1;
    if (json.read_numbers("emissiveFactor", color))
      for (int c = 0; c < 3; ++c) material.emissive[c] = float(color[c] * factor);
    material.emissive_texture = uses_.read(json, "emissiveTexture");
  }

  void read_alpha(const JsonValue& json, Material& material) {
    const std::string mode = json.string_or_empty("alphaMode");
    if (mode == "MASK")
      material.alpha = Material::Alpha::mask;
    else if (mode == "BLEND")
      material.alpha = Material::Alpha::blend;
    else if (!mode.empty() && mode != "OPAQUE")
      warnings_.push_back(json.place() + ".alphaMode: " + printable(mode) + " is unknown, taken as OPAQUE");
    material.alpha_cutoff = float(json.number_or("alphaCutoff", 0.5));
  }

  UseReader& uses_;
  std::vector<std::string>& warnings_;
};

}  // namespace

TextureUse UseReader::read(const JsonValue& json, const char* key) {
  TextureUse use;
  const std::optional<JsonValue> member = json.find(key);
  if (!member) return use;
  const auto transform = member->extension("KHR_texture_transform");
  std::uint64_t set = member->unsigned_or("texCoord", 0);
  if (transform) set = transform->unsigned_or("texCoord", set);
  if (set >= max_texcoord_sets) {
    warnings_.push_back(member->place() + ": uses texture coordinates " + std::to_string(set) + ", of which only " +
                        std::to_string(max_texcoord_sets) + " sets are read; the texture is left out");
    use.texture = lost_texture;
    return use;
  }
  use.set = std::uint32_t(set);
  use.texture = textures_.intern(member->require("index"), warnings_);
  if (use.texture == lost_texture) return use;
  sets_ |= 1u << use.set;
  if (!transform) return use;
  double pair[2];
  if (transform->read_numbers("offset", pair)) use.offset = {pair[0], pair[1]};
  if (transform->read_numbers("scale", pair)) use.scale = {pair[0], pair[1]};
  use.rotation = float(transform->number_or("rotation", 0));
  return use;
}

std::string described(const JsonValue& material) {
  const std::string name = printable(material.name());
  return name.empty() ? material.place() : material.place() + " (" + name + ")";
}

MaterialList read_materials(const JsonValue& root, TextureTable& textures, std::vector<std::string>& warnings) {
  MaterialList out;
  const std::optional<JsonValue> array = root.find("materials");
  // A million materials take half a gigabyte, so the list must not be copied while it grows.
  if (array) out.materials.reserve(array->size());
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    UseReader uses(textures, warnings);
    out.materials.push_back(MaterialReader(uses, warnings).read((*array)[i]));
    out.texcoord_sets.push_back(uses.sets());
  }
  const auto spreads_light = [](const Material& m) {
    return m.transmission.factor > 0 && (m.roughness > 0 || m.volume.thickness > 0);
  };
  if (std::any_of(out.materials.begin(), out.materials.end(), spreads_light))
    warnings.push_back(
        "KHR_materials_transmission: light passes straight on: what is seen through is neither blurred nor bent");
  return out;
}

}  // namespace frontmost::gltf
