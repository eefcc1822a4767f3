// SPDX-License-Identifier: Apache-2.0
// A scene's materials with prepared textures, and their data for each fragment.
#pragma once

#include <memory>
#include <optional>

#include "shade/batch.h"
#include "shade/geometry/triangle_setup.h"
#include "shade/material/material_layers.h"
#include "shade/texture/texture_sampler.h"

namespace frontmost::shading {

struct MaterialRow {
  Material factors;
  TextureSlot base_color, metallic_roughness, normal, emissive, occlusion;
  std::unique_ptr<LayerRow> layers;  ///< null: none
  std::uint32_t further_sets = 0;    ///< bit k: a texture uses set k of coordinates, for k > 0

  [[nodiscard]] bool has_textures() const {
    return base_color.pyramid || metallic_roughness.pyramid || normal.pyramid || emissive.pyramid ||
           occlusion.pyramid || (layers && layers->has_textures());
  }
};

/// The material of triangles without one: a light neutral grey whose shape shows on a white page.
[[nodiscard]] Material default_material();

class MaterialTable {
 public:
  /// Borrows `scene`. No textures are prepared yet.
  explicit MaterialTable(const Scene& scene);

  /// Makes the missing mip levels of textures of materials that `is_needed`, which has one entry per material. Existing
  /// levels keep their addresses. O(texels), in parallel.
  void make_ready(const std::vector<bool>& is_needed, const Execution& execution);
  /// Whether any material has a texture.
  [[nodiscard]] bool has_textures() const { return has_textures_; }
  /// The factor by which each instance scales lengths.
  [[nodiscard]] const std::vector<float>& length_scales() const { return length_scales_; }
  /// Updates an instance that has moved.
  void follow(std::uint32_t instance) { length_scales_[instance] = length_scale_of(scene_.instances[instance]); }
  /// Whether make_ready() has nothing left to do.
  [[nodiscard]] bool is_ready() const { return unready_ == 0; }

  /// The triangle's material, or a default one, which is white for meshes with colours: grey would dim these.
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
