// SPDX-License-Identifier: Apache-2.0
// A scene's materials with prepared textures, and their data for each fragment.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "shade/batch.h"
#include "shade/geometry/geometry.h"
#include "shade/texture/texture_sampler.h"

namespace frontmost::shading {

/// Applies a normal texture to the fragments of one batch: turns normals in the directions in which texture coordinates
/// grow on the triangle.
class NormalMap {
 public:
  /// Borrows `slot` and `setups`. `scale` multiplies the bumps.
  NormalMap(const TextureSlot& slot, float scale, const std::vector<TriangleSetup>& setups)
      : slot_(slot), scale_(scale), setups_(setups) {}

  /// Turns normal `i`. `texel` is the texture's value, 0 to 1. Triangles without coordinates keep their normals.
  void turn(std::uint16_t triangle, const glm::vec4& texel, int i, Lane3& normals);

 private:
  /// The unit directions on a triangle in which u and v grow. They are zero where the coordinates do not span a plane.
  struct TangentFrame {
    glm::vec3 along_u{0}, along_v{0};
  };
  [[nodiscard]] TangentFrame frame_of(const TriangleSetup& triangle) const;

  const TextureSlot& slot_;
  float scale_;
  const std::vector<TriangleSetup>& setups_;
  int framed_ = -1;  ///< the triangle that frame_ belongs to
  TangentFrame frame_;
};

/// The layers of a material: reflectance, layers on top, and transmission. Materials without layers have no LayerRow,
/// and batches without layered materials pay nothing.
struct LayerRow {
  TextureSlot specular, specular_color, coat, coat_roughness, coat_normal, sheen_color, sheen_roughness, transmission,
      thickness;
  bool has_dielectric = false, has_coat = false, has_sheen = false, has_transmission = false;
  float straight = 0.04f;   ///< reflectance at normal incidence, by the index of refraction
  glm::vec3 absorption{0};  ///< log2 of the light left after one world unit of length, by channel
};

/// Returns the layers of a material, or null if it has none. Textures are not set yet. Precondition: limit_numbers()
/// was called.
[[nodiscard]] std::unique_ptr<LayerRow> layers_of(const Material& material);

/// Returns the factor by which an instance scales lengths, or 0 if it is flattened.
[[nodiscard]] float length_scale_of(const Instance& instance);

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
        coat_normal_(row.coat_normal, factors.clearcoat.normal_scale, input.setups) {}

  /// Sets the lanes of the layers to the material's factors. Must come before textures are looked up and normals
  /// turned.
  void fill_factors(int begin, int end);
  /// Looks up textures: sample(slot, use) calls use(i, value) for the fragments of a part of the run.
  template <class Sample>
  void look_up(const Sample& sample);
  /// Computes the lanes that need all other material data, which must be known.
  void settle(int begin, int end);

 private:
  /// Begins lanes that no earlier material of the batch needed: gives all fragments values without effect.
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

struct MaterialRow {
  Material factors;
  TextureSlot base_color, metallic_roughness, normal, emissive, occlusion;
  std::unique_ptr<LayerRow> layers;  ///< null: none
  std::uint32_t further_sets = 0;    ///< bit k: a texture uses set k of coordinates, for k > 0
  bool has_textures = false;         ///< some texture is prepared
};

class MaterialTable {
 public:
  /// Borrows `scene`. No textures are prepared yet.
  explicit MaterialTable(const Scene& scene);

  /// Makes the missing mip levels of the textures of all needed materials. `is_needed` has one entry per material.
  /// Existing levels keep their addresses. O(texels), in parallel.
  void make_ready(const std::vector<bool>& is_needed, const Execution& execution);
  /// Whether any material has a texture.
  [[nodiscard]] bool has_textures() const { return has_textures_; }
  /// Returns the factor by which each instance scales lengths.
  [[nodiscard]] const std::vector<float>& length_scales() const { return length_scales_; }
  /// Updates an instance that has moved.
  void follow(std::uint32_t instance) { length_scales_[instance] = length_scale_of(scene_.instances[instance]); }
  /// Whether make_ready() has nothing left to do.
  [[nodiscard]] bool is_ready() const { return unready_ == 0; }

  /// Returns the triangle's material, or the default one. The default is white for meshes with colours, which grey
  /// would dim.
  [[nodiscard]] const MaterialRow& row_of(const TriangleSetup& triangle) const {
    if (triangle.material < rows_.size()) return rows_[triangle.material];
    return triangle.has_color ? white_ : default_;
  }

 private:
  void make_layers_ready(MaterialRow& row, const Execution& execution);
  [[nodiscard]] TextureSlot slot(const TextureUse& use, Encoding encoding, const Execution& execution);

  const Scene& scene_;
  std::vector<float> length_scales_;
  std::vector<MaterialRow> rows_;  ///< by material
  std::vector<bool> is_ready_;     ///< by material
  std::size_t unready_ = 0;        ///< materials with textures that are not ready
  bool has_textures_ = false;
  MaterialRow default_, white_;
  std::vector<std::unique_ptr<Pyramid>> srgb_, linear_;  ///< by texture; null if not used in this encoding
};

/// The part of a material that a picture shows.
enum class MaterialPart : std::uint8_t {
  all,
  color,   ///< base colour and alpha
  normal,  ///< the normal, and alpha
};

/// Looks up the materials of a batch, run by run, with their layers, and turns normals by normal maps. Values that the
/// picture does not show are undefined. `setups` are the triangles that batch.coverage.triangle indexes.
void look_up_materials(const MaterialTable& table, MaterialPart part, const std::vector<TriangleSetup>& setups,
                       FragmentBatch& batch, Isa isa);

}  // namespace frontmost::shading
