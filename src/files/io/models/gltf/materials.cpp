// SPDX-License-Identifier: Apache-2.0
// Reads the materials: metallic-roughness, and the layers of KHR_materials_ior, _specular, _clearcoat, _sheen,
// _transmission, _volume and _pbrSpecularGlossiness (Khronos Group). A use of a texture that cannot be used is marked,
// so that TextureTable::load() knows which materials have to do without the texture.
#include "io/models/gltf/materials.h"

#include <algorithm>

#include "scene/material.h"

namespace frontmost::gltf {
namespace {

/// Reads uses of textures and notes which sets of coordinates they need.
class UseReader {
 public:
  UseReader(TextureTable& textures, std::vector<std::string>& warnings) : textures_(textures), warnings_(warnings) {}

  /// Returns the use of a texture in the member `key` of `json`, which is unset if the member is absent. If the texture
  /// cannot be used, adds a warning, and the use is of lost_texture.
  [[nodiscard]] TextureUse read(const JsonValue& json, const char* key) {
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
    transform->read_vector("offset", use.offset);
    transform->read_vector("scale", use.scale);
    use.rotation = float(transform->number_or("rotation", 0));
    return use;
  }
  /// Bit k is set if set k is used.
  [[nodiscard]] std::uint32_t sets() const { return sets_; }

 private:
  TextureTable& textures_;
  std::vector<std::string>& warnings_;
  std::uint32_t sets_ = 0;
};

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
    read_layers(json, material);
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
        warnings_.push_back(described(json) + ": " + number.name +
                            " is out of range; the nearest value in range is used");
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
    json.read_vector("baseColorFactor", material.base_color);
    material.metallic = float(json.number_or("metallicFactor", 1));
    material.roughness = float(json.number_or("roughnessFactor", 1));
    material.base_color_texture = uses_.read(json, "baseColorTexture");
    material.metallic_roughness_texture = uses_.read(json, "metallicRoughnessTexture");
  }

  void read_emissive(const JsonValue& json, Material& material) {
    glm::dvec3 color(material.emissive);
    const auto strength = json.extension("KHR_materials_emissive_strength");
    const double factor = strength ? strength->number_or("emissiveStrength", 1) : 1;
    json.read_vector("emissiveFactor", color);
    material.emissive = glm::vec3(color * factor);
    material.emissive_texture = uses_.read(json, "emissiveTexture");
  }

  void read_alpha(const JsonValue& json, Material& material) {
    const std::string mode = json.string_or_empty("alphaMode");
    if (mode == "MASK")
      material.alpha = Material::Alpha::mask;
    else if (mode == "BLEND")
      material.alpha = Material::Alpha::blend;
    else if (!mode.empty() && mode != "OPAQUE")
      warnings_.push_back(json.place() + ".alphaMode: " + printable(mode) + " is unknown; OPAQUE is used");
    material.alpha_cutoff = float(json.number_or("alphaCutoff", 0.5));
  }

  /// Reads the layers that extensions add: mirror reflection, coats, and transmission.
  ///
  ///   specular, glossiness  -->  a mirror (ior 0) of the specular colour over a matt base: no metal at all
  void read_layers(const JsonValue& json, Material& material) {
    // Specular-glossiness comes first, because the extensions _ior and _specular override its ior and specular.
    if (const auto layer = json.extension("KHR_materials_pbrSpecularGlossiness"))
      read_specular_glossiness(*layer, material);
    if (const auto layer = json.extension("KHR_materials_ior")) material.ior = float(layer->number_or("ior", 1.5));
    if (const auto layer = json.extension("KHR_materials_specular")) read_specular(*layer, material);
    if (const auto layer = json.extension("KHR_materials_clearcoat")) read_clearcoat(*layer, material);
    if (const auto layer = json.extension("KHR_materials_sheen")) read_sheen(*layer, material);
    if (const auto layer = json.extension("KHR_materials_transmission")) read_transmission(*layer, material);
    if (const auto layer = json.extension("KHR_materials_volume")) read_volume(*layer, material);
  }

  /// Reads specular-glossiness. Glossiness in a texture is lost, because it is the alpha channel of a colour texture.
  void read_specular_glossiness(const JsonValue& json, Material& material) {
    material.base_color = glm::vec4(1);
    json.read_vector("diffuseFactor", material.base_color);
    material.base_color_texture = uses_.read(json, "diffuseTexture");
    material.metallic = material.ior = 0;
    material.roughness = float(1 - json.number_or("glossinessFactor", 1));
    material.metallic_roughness_texture = {};
    json.read_vector("specularFactor", material.specular.color);
    material.specular.color_texture = uses_.read(json, "specularGlossinessTexture");
  }

  void read_specular(const JsonValue& json, Material& material) {
    Material::Specular& specular = material.specular;
    specular.factor = float(json.number_or("specularFactor", 1));
    specular.factor_texture = uses_.read(json, "specularTexture");
    json.read_vector("specularColorFactor", specular.color);
    specular.color_texture = uses_.read(json, "specularColorTexture");
  }

  void read_clearcoat(const JsonValue& json, Material& material) {
    Material::Clearcoat& coat = material.clearcoat;
    coat.factor = float(json.number_or("clearcoatFactor", 0));
    coat.factor_texture = uses_.read(json, "clearcoatTexture");
    coat.roughness = float(json.number_or("clearcoatRoughnessFactor", 0));
    coat.roughness_texture = uses_.read(json, "clearcoatRoughnessTexture");
    coat.normal_texture = uses_.read(json, "clearcoatNormalTexture");
    if (const auto normal = json.find("clearcoatNormalTexture"))
      coat.normal_scale = float(normal->number_or("scale", 1));
  }

  void read_sheen(const JsonValue& json, Material& material) {
    Material::Sheen& sheen = material.sheen;
    json.read_vector("sheenColorFactor", sheen.color);
    sheen.color_texture = uses_.read(json, "sheenColorTexture");
    sheen.roughness = float(json.number_or("sheenRoughnessFactor", 0));
    sheen.roughness_texture = uses_.read(json, "sheenRoughnessTexture");
  }

  void read_transmission(const JsonValue& json, Material& material) {
    material.transmission.factor = float(json.number_or("transmissionFactor", 0));
    material.transmission.factor_texture = uses_.read(json, "transmissionTexture");
  }

  void read_volume(const JsonValue& json, Material& material) {
    Material::Volume& volume = material.volume;
    volume.thickness = float(json.number_or("thicknessFactor", 0));
    volume.thickness_texture = uses_.read(json, "thicknessTexture");
    constexpr double infinite = std::numeric_limits<double>::infinity();
    volume.attenuation_distance = float(json.number_or("attenuationDistance", infinite));
    json.read_vector("attenuationColor", volume.attenuation_color);
  }

  UseReader& uses_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::string described(const JsonValue& material) {
  const std::string name = printable(material.name());
  return name.empty() ? material.place() : material.place() + " (" + name + ")";
}

MaterialList read_materials(const JsonValue& root, TextureTable& textures, std::vector<std::string>& warnings) {
  MaterialList out;
  // A million materials take half a gigabyte, so the list must not be copied while it grows.
  out.materials.reserve(root.count("materials"));
  root.each("materials", [&](const JsonValue& json) {
    UseReader uses(textures, warnings);
    out.materials.push_back(MaterialReader(uses, warnings).read(json));
    out.texcoord_sets.push_back(uses.sets());
  });
  const auto spreads_light = [](const Material& m) {
    return m.transmission.factor > 0 && (m.roughness > 0 || m.volume.thickness > 0);
  };
  if (std::any_of(out.materials.begin(), out.materials.end(), spreads_light))
    warnings.push_back(
        "KHR_materials_transmission: light passes straight through; rough glass does not blur, and thick glass does "
        "not refract");
  return out;
}

}  // namespace frontmost::gltf
