// SPDX-License-Identifier: Apache-2.0
#include "shade/material/materials.h"

#include <algorithm>

#include "scene/material.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {
namespace {

/// Looks up textures for one run after another.
struct TextureReader {
  TextureSampler sampler;
  Isa isa;
  TexcoordLanes further[max_texcoord_sets - 1];  ///< sets 1 and up, if the current run needs them

  explicit TextureReader(Isa for_isa) : sampler(for_isa), isa(for_isa) {}
};

/// A run of fragments with the same material.
class MaterialRun {
 public:
  MaterialRun(const MaterialRow& row, const LayerInput& input, FragmentBatch& batch, TextureReader& textures)
      : row_(row),
        setups_(input.setups),
        batch_(batch),
        textures_(textures),
        normals_(row.normal, row.factors.normal_scale) {
    if (row.layers) layers_.emplace(row.factors, *row.layers, input, batch);
  }

  void fill(int begin, int end, MaterialPart part) {
    fill_factors(begin, end);
    if (layers_) layers_->fill_factors(begin, end);
    for (std::uint32_t set = 1; set < max_texcoord_sets; ++set)
      if (row_.further_sets >> set & 1)
        interpolate_texcoords({setups_, batch_.coverage, set, begin, end}, textures_.further[set - 1], textures_.isa);
    for (int first = begin; first < end && row_.has_textures(); first += sampled_at_once)
      look_up(first, std::min(first + sampled_at_once, end), part);
    if (layers_) layers_->settle(begin, end);
    settle_alpha(begin, end);
  }

 private:
  void fill_factors(int begin, int end) {
    const Material& m = row_.factors;
    Reflectance& out = batch_.material;
    for (int i = begin; i < end; ++i) {
      out.base.set(i, glm::vec3(m.base_color) * batch_.geometry.color.at(i));
      out.alpha[i] = m.base_color.a * batch_.geometry.alpha[i];
      out.emissive.set(i, m.emissive);
      out.metallic[i] = m.metallic;
      out.roughness[i] = m.roughness;
      out.occlusion[i] = 1.0f;
      out.unlit[i] = m.unlit ? 1.0f : 0.0f;
    }
  }

  /// Triangles without texture coordinates look at the origin, as if all coordinates were 0.
  void look_up(int begin, int end, MaterialPart part) {
    Reflectance& out = batch_.material;
    glm::vec4 values[sampled_at_once];
    std::uint32_t set = max_texcoord_sets;
    const auto sample = [&](const TextureSlot& slot, const auto& use) {
      if (!slot.pyramid) return;
      if (slot.set != set) textures_.sampler.begin(texcoords_of(slot.set), begin, end);
      set = slot.set;
      textures_.sampler.sample(*slot.pyramid, slot.transform, values);
      for (int i = begin; i < end; ++i) use(i, values[i - begin]);
    };
    const bool shows_color = part != MaterialPart::normal || row_.factors.alpha == Material::Alpha::blend;
    if (shows_color) {
      sample(row_.base_color, [&](int i, const glm::vec4& color) {
        out.base.set(i, out.base.at(i) * glm::vec3(color));
        out.alpha[i] *= color.a;
      });
    }
    if (part == MaterialPart::all) {
      sample(row_.metallic_roughness, [&](int i, const glm::vec4& value) {
        out.roughness[i] *= value.g;
        out.metallic[i] *= value.b;
      });
      sample(row_.occlusion, [&](int i, const glm::vec4& value) {
        out.occlusion[i] = 1.0f + row_.factors.occlusion_strength * (value.r - 1.0f);
      });
      sample(row_.emissive,
             [&](int i, const glm::vec4& color) { out.emissive.set(i, out.emissive.at(i) * glm::vec3(color)); });
    }
    if (layers_ && part != MaterialPart::normal) layers_->look_up(sample);
    if (part != MaterialPart::color) {
      sample(row_.normal, [&](int i, const glm::vec4& value) {
        const std::uint16_t triangle = batch_.coverage.triangle[i];
        normals_.turn({setups_[triangle], triangle}, value, i, batch_.geometry.normal);
      });
    }
  }

  [[nodiscard]] const TexcoordLanes& texcoords_of(std::uint32_t set) const {
    return set == 0 ? batch_.geometry.texcoord : textures_.further[set - 1];
  }

  /// Sets alpha by the material's alpha mode; fragments without blending are opaque.
  void settle_alpha(int begin, int end) {
    for (int i = begin; i < end; ++i) {
      float& alpha = batch_.material.alpha[i];
      switch (row_.factors.alpha) {
        case Material::Alpha::opaque: alpha = 1.0f; break;
        case Material::Alpha::mask: alpha = 1.0f; break;  // fragments in holes do not exist
        case Material::Alpha::blend: alpha = alpha > 0 ? std::min(alpha, 1.0f) : 0.0f; break;  // 0 for NaN
      }
    }
  }

  const MaterialRow& row_;
  const std::vector<TriangleSetup>& setups_;
  FragmentBatch& batch_;
  TextureReader& textures_;
  NormalMap normals_;
  std::optional<LayerRun> layers_;  ///< none if the material has no layers
};

bool uses_textures(const Material& m) {
  const auto uses = texture_uses_of(m);
  return std::any_of(uses.begin(), uses.end(), [](const TextureUse* use) { return use->is_set(); });
}

}  // namespace

Material default_material() {
  Material material;
  material.base_color = glm::vec4(0.66f, 0.675f, 0.70f, 1.0f);
  material.roughness = 0.5f;
  return material;
}

MaterialTable::MaterialTable(const Scene& scene)
    : scene_(scene),
      length_scales_(length_scales_of(scene)),
      srgb_(scene.textures.size()),
      linear_(scene.textures.size()) {
  rows_.reserve(scene.materials.size());
  for (const Material& m : scene.materials) {
    MaterialRow& row = rows_.emplace_back();
    row.factors = m;
    limit_numbers(row.factors);
    row.layers = layers_of(row.factors);
    is_ready_.push_back(!uses_textures(m));
    unready_ += !is_ready_.back();
  }
  has_textures_ = unready_ > 0;
  default_.factors = white_.factors = default_material();
  white_.factors.base_color = glm::vec4(1);
}

void MaterialTable::make_ready(const std::vector<bool>& is_needed, const Execution& execution) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (is_ready_[i] || !is_needed[i]) continue;
    MaterialRow& row = rows_[i];
    const Material& m = row.factors;
    row.base_color = slot(m.base_color_texture, Encoding::srgb, execution);
    row.emissive = slot(m.emissive_texture, Encoding::srgb, execution);
    row.metallic_roughness = slot(m.metallic_roughness_texture, Encoding::linear, execution);
    row.normal = slot(m.normal_texture, Encoding::linear, execution);
    row.occlusion = slot(m.occlusion_texture, Encoding::linear, execution);
    if (row.layers) make_layers_ready(row, execution);
    for (const TextureUse* use : texture_uses_of(m))
      if (use->is_set() && use->set > 0) row.further_sets |= 1u << use->set;
    is_ready_[i] = true;
    --unready_;
  }
}

void MaterialTable::make_layers_ready(MaterialRow& row, const Execution& execution) {
  const Material& m = row.factors;
  LayerRow& out = *row.layers;
  const auto colors = [&](const TextureUse& use) { return slot(use, Encoding::srgb, execution); };
  const auto numbers = [&](const TextureUse& use) { return slot(use, Encoding::linear, execution); };
  if (out.has_dielectric) {
    out.specular = numbers(m.specular.factor_texture);
    out.specular_color = colors(m.specular.color_texture);
  }
  if (out.has_coat) {
    out.coat = numbers(m.clearcoat.factor_texture);
    out.coat_roughness = numbers(m.clearcoat.roughness_texture);
    out.coat_normal = numbers(m.clearcoat.normal_texture);
  }
  if (out.has_sheen) {
    out.sheen_color = colors(m.sheen.color_texture);
    out.sheen_roughness = numbers(m.sheen.roughness_texture);
  }
  if (out.has_transmission) {
    out.transmission = numbers(m.transmission.factor_texture);
    out.thickness = numbers(m.volume.thickness_texture);
  }
}

TextureSlot MaterialTable::slot(const TextureUse& use, Encoding encoding, const Execution& execution) {
  if (!use.is_set()) return {};
  std::unique_ptr<Pyramid>& pyramid = (encoding == Encoding::srgb ? srgb_ : linear_)[use.texture];
  if (!pyramid) pyramid = std::make_unique<Pyramid>(scene_.textures[use.texture], encoding, execution);
  return {pyramid.get(), TexcoordTransform(use), use.set};
}

void look_up_materials(const MaterialTable& table, MaterialPart part, const std::vector<TriangleSetup>& setups,
                       FragmentBatch& batch, Isa isa) {
  TextureReader textures(isa);
  batch.layers.clear();
  const LayerInput input{setups, table.length_scales()};
  const Coverage& coverage = batch.coverage;
  const auto row_at = [&](int i) { return &table.row_of(setups[coverage.triangle[i]]); };
  for (int begin = 0; begin < coverage.count;) {
    const MaterialRow* const row = row_at(begin);
    int end = begin + 1;
    while (end < coverage.count && row_at(end) == row) ++end;
    MaterialRun(*row, input, batch, textures).fill(begin, end, part);
    begin = end;
  }
}

}  // namespace frontmost::shading
