// SPDX-License-Identifier: Apache-2.0
// One material after the other. A factor without its texture would say something else than the file means, so a
// material whose texture is lost is told, and loses the factor where the factor alone would be wrong.
#include "io/models/gltf/materials.h"

#include "io/models/textures.h"

namespace frontmost::gltf {
namespace {

/// Reads one material.
class MaterialReader {
 public:
  MaterialReader(TextureTable& textures, std::vector<std::string>& warnings)
      : textures_(textures), warnings_(warnings) {}

  Material read(const JsonValue& json) {
    Material material;
    material.name = json.name();
    // glTF's defaults, which differ from those of a material of our own.
    material.metallic = material.roughness = 1;
    if (const auto pbr = json.find("pbrMetallicRoughness")) read_metallic_roughness(*pbr, material);
    if (const auto normal = json.find("normalTexture")) {
      material.normal_texture = read_use(*normal);
      material.normal_scale = float(normal->number_or("scale", 1));
    }
    if (const auto occlusion = json.find("occlusionTexture")) {
      material.occlusion_texture = read_use(*occlusion);
      material.occlusion_strength = float(occlusion->number_or("strength", 1));
    }
    read_emissive(json, material);
    do_without_lost(json, material);
    read_alpha(json, material);
    material.double_sided = json.bool_or("doubleSided", false);
    material.unlit = json.extension("KHR_materials_unlit").has_value();
    return material;
  }

  [[nodiscard]] std::uint32_t texcoord_set() const { return set_ == no_index ? 0 : set_; }

 private:
  void read_metallic_roughness(const JsonValue& json, Material& material) {
    double color[4];
    if (json.read_numbers("baseColorFactor", color))
      for (int c = 0; c < 4; ++c) material.base_color[c] = float(color[c]);
    material.metallic = float(json.number_or("metallicFactor", 1));
    material.roughness = float(json.number_or("roughnessFactor", 1));
    if (const auto texture = json.find("baseColorTexture")) material.base_color_texture = read_use(*texture);
    if (const auto texture = json.find("metallicRoughnessTexture"))
      material.metallic_roughness_texture = read_use(*texture);
  }

  void read_emissive(const JsonValue& json, Material& material) {
    double color[3];
    const auto strength = json.extension("KHR_materials_emissive_strength");
    const double factor = strength ? strength->number_or("emissiveStrength", 1) : 1;
    if (json.read_numbers("emissiveFactor", color))
      for (int c = 0; c < 3; ++c) material.emissive[c] = float(color[c] * factor);
    if (const auto texture = json.find("emissiveTexture")) material.emissive_texture = read_use(*texture);
  }

  void do_without_lost(const JsonValue& json, Material& material) {
    const std::string who = described(json);
    const auto pbr = json.find("pbrMetallicRoughness");
    if (pbr && pbr->find("metallicRoughnessTexture") && !material.metallic_roughness_texture.is_set())
      lose_metallic_roughness_texture(material, who, warnings_);
    if (json.find("emissiveTexture") && !material.emissive_texture.is_set())
      lose_emissive_texture(material, who, warnings_);
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

  TextureUse read_use(const JsonValue& json) {
    const auto transform = json.extension("KHR_texture_transform");
    std::uint64_t set = json.unsigned_or("texCoord", 0);
    if (transform) set = transform->unsigned_or("texCoord", set);
    if (!agrees(set, json)) return {};
    TextureUse use;
    use.texture = textures_.intern(json.require("index"), warnings_);
    if (!use.is_set() || !transform) return use;
    double pair[2];
    if (transform->read_numbers("offset", pair)) use.offset = {pair[0], pair[1]};
    if (transform->read_numbers("scale", pair)) use.scale = {pair[0], pair[1]};
    use.rotation = float(transform->number_or("rotation", 0));
    return use;
  }

  /// The first texture of a material, the base colour's if there is one, decides about the set.
  bool agrees(std::uint64_t set, const JsonValue& json) {
    if (set_ == no_index && set < max_texcoord_sets) set_ = std::uint32_t(set);
    if (set == set_) return true;
    warnings_.push_back(json.place() + ": uses texture coordinates " + std::to_string(set) +
                        (set_ == no_index ? "" : " where the base colour uses " + std::to_string(set_)) +
                        ", the texture is left out");
    return false;
  }

  TextureTable& textures_;
  std::vector<std::string>& warnings_;
  std::uint32_t set_ = no_index;
};

}  // namespace

std::string described(const JsonValue& material) {
  const std::string name = printable(material.name());
  return name.empty() ? material.place() : material.place() + " (" + name + ")";
}

MaterialList read_materials(const JsonValue& root, TextureTable& textures, std::vector<std::string>& warnings) {
  MaterialList out;
  const std::optional<JsonValue> array = root.find("materials");
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    MaterialReader reader(textures, warnings);
    out.materials.push_back(reader.read((*array)[i]));
    out.texcoord_sets.push_back(reader.texcoord_set());
  }
  return out;
}

}  // namespace frontmost::gltf
