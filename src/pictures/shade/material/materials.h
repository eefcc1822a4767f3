// SPDX-License-Identifier: Apache-2.0
// A scene's materials with their textures made ready, and what they say of each fragment.
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
  std::uint32_t further_sets = 0;    ///< bit k: a texture is looked up by set k, which is not the first

  [[nodiscard]] bool has_textures() const {
    return base_color.pyramid || metallic_roughness.pyramid || normal.pyramid || emissive.pyramid ||
           occlusion.pyramid || (layers && layers->has_textures());
  }
};

/// What triangles without a material are made of: a light neutral grey that shows its form on a white page.
[[nodiscard]] Material default_material();

class MaterialTable {
 public:
  /// Borrows `scene`. No textures are made ready yet.
  explicit MaterialTable(const Scene& scene);

  /// Makes the mip levels of the textures of materials that `is_needed`, one entry per material, where they are not
  /// there yet. What was there stays in its place. O(texels), in parallel.
  void make_ready(const std::vector<bool>& is_needed, const Execution& execution);
  /// Whether any material has a texture.
  [[nodiscard]] bool has_textures() const { return has_textures_; }
  /// By how much each instance makes lengths longer.
  [[nodiscard]] const std::vector<float>& length_scales() const { return length_scales_; }
  /// Follows an instance to where it is now.
  void follow(std::uint32_t instance) { length_scales_[instance] = length_scale_of(scene_.instances[instance]); }
  /// Nothing is left that make_ready() could make.
  [[nodiscard]] bool is_ready() const { return unready_ == 0; }

  /// Without a material the default one, which is white where the mesh brings colours: its grey would dim them.
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
  std::vector<std::unique_ptr<Pyramid>> srgb_, linear_;  ///< by texture; null where not used so
};

/// What of materials a picture shows.
enum class MaterialPart : std::uint8_t {
  all,
  color,   ///< base colour and alpha
  normal,  ///< the normal, and alpha
};

/// Looks up the materials of a batch, run by run of equal ones, with their layers, and turns its normals by normal
/// maps; what the picture does not show is undefined. `setups` are the triangles that batch.coverage.triangle numbers.
void look_up_materials(const MaterialTable& table, MaterialPart part, const std::vector<TriangleSetup>& setups,
                       FragmentBatch& batch, Isa isa);

}  // namespace frontmost::shading
