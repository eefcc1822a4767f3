// SPDX-License-Identifier: Apache-2.0
// Layers that extensions add to a material: mirror reflection, coats, and transmission. The layers follow the
// specifications of KHR_materials_ior, _specular, _clearcoat, _sheen, _transmission, _volume and _pbrSpecularGlossiness
// (Khronos Group).
//
//   specular, glossiness  -->  a mirror (ior 0) of the specular colour over a matt base: no metal at all
#include "io/models/gltf/materials.h"

namespace frontmost::gltf {
namespace {

/// Reads the layers of one material.
class LayerReader {
 public:
  LayerReader(const JsonValue& json, UseReader& uses, Material& material)
      : json_(json), uses_(uses), material_(material) {}

  void read() {
    // Specular-glossiness comes first, because its ior and specular give way to extensions of these names.
    if (const auto json = json_.extension("KHR_materials_pbrSpecularGlossiness")) read_specular_glossiness(*json);
    if (const auto json = json_.extension("KHR_materials_ior")) material_.ior = float(json->number_or("ior", 1.5));
    if (const auto json = json_.extension("KHR_materials_specular")) read_specular(*json);
    if (const auto json = json_.extension("KHR_materials_clearcoat")) read_clearcoat(*json);
    if (const auto json = json_.extension("KHR_materials_sheen")) read_sheen(*json);
    if (const auto json = json_.extension("KHR_materials_transmission")) read_transmission(*json);
    if (const auto json = json_.extension("KHR_materials_volume")) read_volume(*json);
  }

 private:
  static void read_color(const JsonValue& json, const char* key, glm::vec3& color) {
    double numbers[3];
    if (json.read_numbers(key, numbers)) color = glm::vec3(glm::dvec3(numbers[0], numbers[1], numbers[2]));
  }

  /// Glossiness by texture is lost, because it lies in the alpha channel of a colour texture.
  void read_specular_glossiness(const JsonValue& json) {
    double diffuse[4] = {1, 1, 1, 1};
    (void)json.read_numbers("diffuseFactor", diffuse);
    for (int c = 0; c < 4; ++c) material_.base_color[c] = float(diffuse[c]);
    material_.base_color_texture = uses_.read(json, "diffuseTexture");
    material_.metallic = material_.ior = 0;
    material_.roughness = float(1 - json.number_or("glossinessFactor", 1));
    material_.metallic_roughness_texture = {};
    read_color(json, "specularFactor", material_.specular.color);
    material_.specular.color_texture = uses_.read(json, "specularGlossinessTexture");
  }

  void read_specular(const JsonValue& json) {
    Material::Specular& specular = material_.specular;
    specular.factor = float(json.number_or("specularFactor", 1));
    specular.factor_texture = uses_.read(json, "specularTexture");
    read_color(json, "specularColorFactor", specular.color);
    specular.color_texture = uses_.read(json, "specularColorTexture");
  }

  void read_clearcoat(const JsonValue& json) {
    Material::Clearcoat& coat = material_.clearcoat;
    coat.factor = float(json.number_or("clearcoatFactor", 0));
    coat.factor_texture = uses_.read(json, "clearcoatTexture");
    coat.roughness = float(json.number_or("clearcoatRoughnessFactor", 0));
    coat.roughness_texture = uses_.read(json, "clearcoatRoughnessTexture");
    coat.normal_texture = uses_.read(json, "clearcoatNormalTexture");
    if (const auto normal = json.find("clearcoatNormalTexture"))
      coat.normal_scale = float(normal->number_or("scale", 1));
  }

  void read_sheen(const JsonValue& json) {
    Material::Sheen& sheen = material_.sheen;
    read_color(json, "sheenColorFactor", sheen.color);
    sheen.color_texture = uses_.read(json, "sheenColorTexture");
    sheen.roughness = float(json.number_or("sheenRoughnessFactor", 0));
    sheen.roughness_texture = uses_.read(json, "sheenRoughnessTexture");
  }

  void read_transmission(const JsonValue& json) {
    material_.transmission.factor = float(json.number_or("transmissionFactor", 0));
    material_.transmission.factor_texture = uses_.read(json, "transmissionTexture");
  }

  void read_volume(const JsonValue& json) {
    Material::Volume& volume = material_.volume;
    volume.thickness = float(json.number_or("thicknessFactor", 0));
    volume.thickness_texture = uses_.read(json, "thicknessTexture");
    constexpr double infinite = std::numeric_limits<double>::infinity();
    volume.attenuation_distance = float(json.number_or("attenuationDistance", infinite));
    read_color(json, "attenuationColor", volume.attenuation_color);
  }

  const JsonValue& json_;
  UseReader& uses_;
  Material& material_;
};

}  // namespace

void read_layers(const JsonValue& json, UseReader& uses, Material& material) {
  LayerReader(json, uses, material).read();
}

}  // namespace frontmost::gltf
