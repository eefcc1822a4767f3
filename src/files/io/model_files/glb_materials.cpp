// SPDX-License-Identifier: Apache-2.0
// Materials in glTF. Values that equal glTF's defaults and layers that are absent are left out.
#include <algorithm>
#include <cmath>

#include "io/model_files/glb_document.h"

namespace frontmost::detail {
namespace {

using Json = nlohmann::ordered_json;

float within(float value, float low, float high) { return std::clamp(std::isfinite(value) ? value : low, low, high); }

Json color_json(const glm::vec3& color) {
  return Json::array({within(color.x, 0, 1), within(color.y, 0, 1), within(color.z, 0, 1)});
}

/// Writes a material, with each use of a texture in the object that it belongs to.
class MaterialWriter {
 public:
  explicit MaterialWriter(GlbDocument& document) : document_(document) {}

  [[nodiscard]] Json write(const Material& material) {
    Json json = {{"name", utf8_text(material.name)}};
    Json& surface = json["pbrMetallicRoughness"];
    Json base = color_json(material.base_color);
    base.push_back(within(material.base_color.w, 0, 1));
    surface["baseColorFactor"] = std::move(base);
    surface["metallicFactor"] = within(material.metallic, 0, 1);
    surface["roughnessFactor"] = within(material.roughness, 0, 1);
    set(surface, "baseColorTexture", material.base_color_texture);
    set(surface, "metallicRoughnessTexture", material.metallic_roughness_texture);
    set_scaled(json, "normalTexture", material.normal_texture, "scale", material.normal_scale);
    set_scaled(json, "occlusionTexture", material.occlusion_texture, "strength",
               within(material.occlusion_strength, 0, 1));
    write_emission(json, material);
    if (material.alpha == Material::Alpha::mask) {
      json["alphaMode"] = "MASK";
      json["alphaCutoff"] = within(material.alpha_cutoff, 0, 1e30f);
    } else if (material.alpha == Material::Alpha::blend) {
      json["alphaMode"] = "BLEND";
    }
    if (material.double_sided) json["doubleSided"] = true;
    write_layers(json, material);
    return json;
  }

 private:
  void set(Json& object, const char* key, const TextureUse& use) {
    if (use.is_set()) object[key] = texture_json(use);
  }
  void set_scaled(Json& object, const char* key, const TextureUse& use, const char* factor, float value) {
    if (!use.is_set()) return;
    object[key] = texture_json(use);
    object[key][factor] = value;
  }
  Json texture_json(const TextureUse& use) {
    Json json = {{"index", document_.texture(use.texture)}};
    if (use.set != 0) json["texCoord"] = use.set;
    if (use.offset == glm::vec2(0) && use.scale == glm::vec2(1) && use.rotation == 0) return json;
    json["extensions"][document_.uses("KHR_texture_transform")] = {
        {"offset", {use.offset.x, use.offset.y}}, {"rotation", use.rotation}, {"scale", {use.scale.x, use.scale.y}}};
    return json;
  }
  /// The strength is written separately if it is above 1.
  void write_emission(Json& json, const Material& material) {
    const float most = std::max({material.emissive.x, material.emissive.y, material.emissive.z});
    set(json, "emissiveTexture", material.emissive_texture);
    if (!(most > 0) || !std::isfinite(most)) return;
    json["emissiveFactor"] = color_json(material.emissive / std::max(most, 1.0f));
    if (most > 1) json["extensions"][document_.uses("KHR_materials_emissive_strength")]["emissiveStrength"] = most;
  }
  void write_layers(Json& json, const Material& material) {
    const auto layer = [&](const char* name) -> Json& {
      return json["extensions"][document_.uses(name)] = Json::object();
    };
    if (material.unlit) {
      layer("KHR_materials_unlit");
      return;  // nothing else counts for an unlit surface
    }
    if (material.ior != 1.5f) layer("KHR_materials_ior")["ior"] = material.ior;
    if (const auto& s = material.specular; s.factor != 1 || s.color != glm::vec3(1)) {
      Json& object = layer("KHR_materials_specular");
      object["specularFactor"] = within(s.factor, 0, 1);
      object["specularColorFactor"] = {s.color.x, s.color.y, s.color.z};
      set(object, "specularTexture", s.factor_texture);
      set(object, "specularColorTexture", s.color_texture);
    }
    if (const auto& c = material.clearcoat; c.factor > 0) {
      Json& object = layer("KHR_materials_clearcoat");
      object["clearcoatFactor"] = within(c.factor, 0, 1);
      object["clearcoatRoughnessFactor"] = within(c.roughness, 0, 1);
      set(object, "clearcoatTexture", c.factor_texture);
      set(object, "clearcoatRoughnessTexture", c.roughness_texture);
      set_scaled(object, "clearcoatNormalTexture", c.normal_texture, "scale", c.normal_scale);
    }
    if (const auto& s = material.sheen; s.color != glm::vec3(0)) {
      Json& object = layer("KHR_materials_sheen");
      object["sheenColorFactor"] = color_json(s.color);
      object["sheenRoughnessFactor"] = within(s.roughness, 0, 1);
      set(object, "sheenColorTexture", s.color_texture);
      set(object, "sheenRoughnessTexture", s.roughness_texture);
    }
    write_glass(layer, material);
  }
  template <class Layer>
  void write_glass(const Layer& layer, const Material& material) {
    if (!(material.transmission.factor > 0)) return;
    Json& glass = layer("KHR_materials_transmission");
    glass["transmissionFactor"] = within(material.transmission.factor, 0, 1);
    set(glass, "transmissionTexture", material.transmission.factor_texture);
    const auto& v = material.volume;
    if (!(v.thickness > 0)) return;
    Json& volume = layer("KHR_materials_volume");
    volume["thicknessFactor"] = v.thickness;
    set(volume, "thicknessTexture", v.thickness_texture);
    if (std::isfinite(v.attenuation_distance)) volume["attenuationDistance"] = v.attenuation_distance;
    volume["attenuationColor"] = color_json(v.attenuation_color);
  }

  GlbDocument& document_;
};

}  // namespace

Json material_json(const Material& material, GlbDocument& document) { return MaterialWriter(document).write(material); }

}  // namespace frontmost::detail
