// SPDX-License-Identifier: Apache-2.0
// The layers of a material with prepared textures, and their data for each fragment: reflectance, layers on top, and
// transmission. Materials without layers have no LayerRow, and batches without layered materials pay nothing.
#pragma once

#include <memory>
#include <vector>

#include "frontmost/scene.h"
#include "shade/batch.h"
#include "shade/geometry/triangle_setup.h"
#include "shade/material/normal_map.h"
#include "shade/texture/texture_sampler.h"

namespace frontmost::shading {

struct LayerRow {
  TextureSlot specular, specular_color, coat, coat_roughness, coat_normal, sheen_color, sheen_roughness, transmission,
      thickness;
  bool has_dielectric = false, has_coat = false, has_sheen = false, has_transmission = false;
  /// Valid once the textures are prepared.
  [[nodiscard]] bool has_textures() const {
    return specular.pyramid || specular_color.pyramid || coat.pyramid || coat_roughness.pyramid ||
           coat_normal.pyramid || sheen_color.pyramid || sheen_roughness.pyramid || transmission.pyramid ||
           thickness.pyramid;
  }
  float straight = 0.04f;   ///< reflectance at normal incidence, by the index of refraction
  glm::vec3 absorption{0};  ///< log2 of the absorption, by channel and world unit of length
};

/// Null if the material has no layers. Textures are not set yet. Precondition: limit_numbers() was called.
[[nodiscard]] std::unique_ptr<LayerRow> layers_of(const Material& material);

/// The factor by which an instance scales lengths; 0 if it is flattened.
[[nodiscard]] float length_scale_of(const Instance& instance);
/// length_scale_of() of every instance.
[[nodiscard]] std::vector<float> length_scales_of(const Scene& scene);

/// The data that all runs of fragments share.
struct LayerInput {
  const std::vector<TriangleSetup>& setups;
  const std::vector<float>& length_scales;  ///< by instance
};

/// A run of fragments with the same layered material.
class LayerRun {
 public:
  LayerRun(const Material& factors, const LayerRow& row, const LayerInput& input, FragmentBatch& batch)
      : m_(factors),
        row_(row),
        input_(input),
        batch_(batch),
        coat_normal_(row.coat_normal, factors.clearcoat.normal_scale) {}

  /// Called before textures are looked up and normals turned.
  void fill_factors(int begin, int end);
  /// `sample(slot, use)` calls use(i, value) for the fragments of a part of the run.
  template <class Sample>
  void look_up(const Sample& sample);
  /// Called when all other material data is known.
  void settle(int begin, int end);

 private:
  /// Makes room for the material's layers; earlier fragments of the batch have none.
  void begin_layers();
  [[nodiscard]] glm::vec3 filter_at(int i) const;
  [[nodiscard]] bool is_way_out(int i) const;

  const Material& m_;
  const LayerRow& row_;
  const LayerInput& input_;
  FragmentBatch& batch_;
  NormalMap coat_normal_;
  Lane thickness_;
};

template <class Sample>
void LayerRun::look_up(const Sample& sample) {
  LayerLanes& out = batch_.layers;
  sample(row_.specular, [&](int i, const glm::vec4& value) { out.f90[i] *= value.a; });
  sample(row_.specular_color, [&](int i, const glm::vec4& color) { out.f0.set(i, out.f0.at(i) * glm::vec3(color)); });
  sample(row_.coat, [&](int i, const glm::vec4& value) { out.coat[i] *= value.r; });
  sample(row_.coat_roughness, [&](int i, const glm::vec4& value) { batch_.coat->material.roughness[i] *= value.g; });
  sample(row_.coat_normal, [&](int i, const glm::vec4& value) {
    const std::uint16_t triangle = batch_.coverage.triangle[i];
    coat_normal_.turn({input_.setups[triangle], triangle}, value, i, batch_.coat->geometry.normal);
  });
  sample(row_.sheen_color,
         [&](int i, const glm::vec4& color) { out.sheen.set(i, out.sheen.at(i) * glm::vec3(color)); });
  sample(row_.sheen_roughness, [&](int i, const glm::vec4& value) { out.sheen_roughness[i] *= value.a; });
  sample(row_.transmission, [&](int i, const glm::vec4& value) { out.transmission[i] *= value.r; });
  sample(row_.thickness, [&](int i, const glm::vec4& value) { thickness_[i] *= value.g; });
}

}  // namespace frontmost::shading
