// SPDX-License-Identifier: Apache-2.0
#include "shade/material/materials.h"

#include <algorithm>
#include <cmath>

#include "scene/material.h"
#include "shade/powers.h"

namespace frontmost::shading {

template <class Sample>
void LayerRun::look_up(const Sample& sample) {
  LayerLanes& out = batch_.layers;
  sample(row_.specular, [&](int i, const glm::vec4& value) { out.f90[i] *= value.a; });
  sample(row_.specular_color, [&](int i, const glm::vec4& color) { out.f0.set(i, out.f0.at(i) * glm::vec3(color)); });
  sample(row_.coat, [&](int i, const glm::vec4& value) { out.coat[i] *= value.r; });
  sample(row_.coat_roughness, [&](int i, const glm::vec4& value) { batch_.coat->material.roughness[i] *= value.g; });
  sample(row_.coat_normal, [&](int i, const glm::vec4& value) {
    coat_normal_.turn(batch_.coverage.triangle[i], value, i, batch_.coat->geometry.normal);
  });
  sample(row_.sheen_color,
         [&](int i, const glm::vec4& color) { out.sheen.set(i, out.sheen.at(i) * glm::vec3(color)); });
  sample(row_.sheen_roughness, [&](int i, const glm::vec4& value) { out.sheen_roughness[i] *= value.a; });
  sample(row_.transmission, [&](int i, const glm::vec4& value) { out.transmission[i] *= value.r; });
  sample(row_.thickness, [&](int i, const glm::vec4& value) { thickness_[i] *= value.g; });
}

namespace {

glm::vec3 direction_or_zero(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && length < 1e300 ? glm::vec3(v / length) : glm::vec3(0);
}

glm::vec3 normalized_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length2 = v.x * v.x + v.y * v.y + v.z * v.z;
  return length2 > 1e-20f && length2 < 1e20f ? v * (1.0f / std::sqrt(length2)) : fallback;
}

void fill(Lane& lane, int count, float value) { std::fill_n(lane.values, count, value); }
void fill(Lane3& lanes, int count, float value) {
  for (Lane* lane : {&lanes.x, &lanes.y, &lanes.z}) fill(*lane, count, value);
}

/// Returns the reflectance at normal incidence between air and this index of refraction. An index of 0 means a mirror.
float straight_reflectance(float ior) {
  const float ratio = (ior - 1) / (ior + 1);
  return ratio * ratio;
}

glm::vec3 absorption_of(const Material::Volume& volume) {
  glm::vec3 absorption;
  // A black volume absorbs everything at once. The limit keeps its coefficient finite.
  constexpr float least = 1e-30f;
  for (int c = 0; c < 3; ++c)
    absorption[c] = log2_of(std::max(volume.attenuation_color[c], least)) / volume.attenuation_distance;
  return absorption;
}

/// Looks up textures for one run after another.
struct TextureReader {
  explicit TextureReader(Isa for_isa) : isa(for_isa), sampler(for_isa) {}

  Isa isa;
  TextureSampler sampler;
  TexcoordLanes further[max_texcoord_sets - 1];  ///< sets 1 and up, if the current run needs them
};

/// A run of fragments with the same material.
class MaterialRun {
 public:
  MaterialRun(const MaterialRow& row, const LayerInput& input, FragmentBatch& batch, TextureReader& textures)
      : row_(row),
        setups_(input.setups),
        batch_(batch),
        textures_(textures),
        normals_(row.normal, row.factors.normal_scale, input.setups) {
    if (row.layers) layers_.emplace(row.factors, *row.layers, input, batch);
  }

  void fill(int begin, int end, MaterialPart part) {
    fill_factors(begin, end);
    if (layers_) layers_->fill_factors(begin, end);
    for (std::uint32_t set = 1; set < max_texcoord_sets; ++set)
      if (row_.further_sets >> set & 1)
        interpolate_texcoords({setups_, batch_.coverage, set, begin, end}, textures_.further[set - 1], textures_.isa);
    for (int first = begin; first < end && row_.has_textures; first += sampled_at_once)
      look_up(first, std::min(first + sampled_at_once, end), part);
    if (layers_) layers_->settle(begin, end);
    settle_alpha(begin, end);
  }

 private:
  void fill_factors(int begin, int end) {
    const Material& m = row_.factors;
    const Geometry& g = batch_.geometry;
    Reflectance& out = batch_.material;
    const auto set = [&](Lane& lane, float value) { std::fill(lane.values + begin, lane.values + end, value); };
    const auto scale = [&](Lane& lane, const Lane& colors, float factor) {
      if (!g.has_color) return set(lane, factor);
      for (int i = begin; i < end; ++i) lane[i] = factor * colors[i];
    };
    scale(out.base.x, g.color.x, m.base_color.r);
    scale(out.base.y, g.color.y, m.base_color.g);
    scale(out.base.z, g.color.z, m.base_color.b);
    scale(out.alpha, g.alpha, m.base_color.a);
    set(out.emissive.x, m.emissive.r);
    set(out.emissive.y, m.emissive.g);
    set(out.emissive.z, m.emissive.b);
    set(out.metallic, m.metallic);
    set(out.roughness, m.roughness);
    set(out.occlusion, 1.0f);
    set(out.unlit, m.unlit ? 1.0f : 0.0f);
  }

  /// Looks up the textures of the fragments [begin, end). Triangles without texture coordinates use the texel at the
  /// origin.
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
        normals_.turn(batch_.coverage.triangle[i], value, i, batch_.geometry.normal);
      });
    }
  }

  [[nodiscard]] const TexcoordLanes& texcoords_of(std::uint32_t set) const {
    return set == 0 ? batch_.geometry.texcoord : textures_.further[set - 1];
  }

  /// Sets alpha by the material's alpha mode. Fragments without blending are opaque.
  void settle_alpha(int begin, int end) {
    float* const alpha = batch_.material.alpha.values;
    if (row_.factors.alpha != Material::Alpha::blend)  // fragments in holes do not exist
      return std::fill(alpha + begin, alpha + end, 1.0f);
    for (int i = begin; i < end; ++i) alpha[i] = alpha[i] > 0 ? std::min(alpha[i], 1.0f) : 0.0f;  // 0 for NaN
  }

  const MaterialRow& row_;
  const std::vector<TriangleSetup>& setups_;
  FragmentBatch& batch_;
  TextureReader& textures_;
  NormalMap normals_;
  std::optional<LayerRun> layers_;  ///< none if the material has no layers
};

/// Returns the material of triangles without one: a light neutral grey whose shape shows on a white page.
Material default_material() {
  Material material;
  material.base_color = glm::vec4(0.66f, 0.675f, 0.70f, 1.0f);
  material.roughness = 0.5f;
  return material;
}

bool uses_textures(const Material& m) {
  const auto uses = texture_uses_of(m);
  return std::any_of(uses.begin(), uses.end(), [](const TextureUse* use) { return use->is_set(); });
}

}  // namespace

NormalMap::TangentFrame NormalMap::frame_of(const TriangleSetup& t) const {
  std::array<glm::dvec2, 3> uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] = glm::dvec2(slot_.transform.place(t.texcoord[slot_.set][k]));
  const glm::dvec3 edge1 = glm::dvec3(t.corner[1] - t.corner[0]), edge2 = glm::dvec3(t.corner[2] - t.corner[0]);
  const glm::dvec2 uv1 = uv[1] - uv[0], uv2 = uv[2] - uv[0];
  const double area = uv1.x * uv2.y - uv2.x * uv1.y;
  const double sign = area < 0 ? -1 : 1;
  return {direction_or_zero((edge1 * uv2.y - edge2 * uv1.y) * sign),
          direction_or_zero((edge2 * uv1.x - edge1 * uv2.x) * sign)};
}

void NormalMap::turn(std::uint16_t triangle, const glm::vec4& texel, int i, Lane3& normals) {
  const TriangleSetup& t = setups_[triangle];
  if (!t.has_texcoord[slot_.set]) return;
  if (triangle != framed_) frame_ = frame_of(t);
  framed_ = triangle;
  const glm::vec3 map = glm::vec3(texel) * 2.0f - 1.0f;
  const glm::vec3 n = normals.at(i);
  const glm::vec3 u = frame_.along_u - n * glm::dot(n, frame_.along_u);
  const glm::vec3 v = frame_.along_v - n * glm::dot(n, frame_.along_v);
  // Green points up in the picture, against v. On the back of a surface, bumps are inverted.
  const float side = (t.is_backside ? -1.0f : 1.0f) * scale_;
  const glm::vec3 turned = normalized_or(u, u) * (map.x * side) - normalized_or(v, v) * (map.y * side) + n * map.z;
  normals.set(i, normalized_or(turned, n));
}

std::unique_ptr<LayerRow> layers_of(const Material& m) {
  if (m.unlit) return nullptr;
  LayerRow row;
  row.has_transmission = m.transmission.factor > 0;
  const Material::Specular& s = m.specular;
  row.has_dielectric = row.has_transmission || m.ior != 1.5f || s.factor != 1 || s.color != glm::vec3(1) ||
                       s.factor_texture.is_set() || s.color_texture.is_set();
  row.has_coat = m.clearcoat.factor > 0;
  row.has_sheen = m.sheen.color != glm::vec3(0);
  if (!row.has_dielectric && !row.has_coat && !row.has_sheen) return nullptr;
  if (m.ior != 1.5f) row.straight = straight_reflectance(m.ior);
  row.absorption = absorption_of(m.volume);
  return std::make_unique<LayerRow>(row);
}

float length_scale_of(const Instance& instance) {
  return float(std::cbrt(std::abs(glm::determinant(glm::dmat3(instance.world_from_mesh)))));
}

void LayerRun::begin_layers() {
  LayerLanes& out = batch_.layers;
  const int count = batch_.coverage.count;
  if (row_.has_dielectric && !out.has_dielectric) {
    fill(out.is_dielectric, count, 0);
    fill(out.f0, count, 0.04f);
    fill(out.f90, count, 1);
    fill(out.transmission, count, 0);
    out.has_dielectric = true;
  }
  if (row_.has_transmission && !out.has_transmission) {
    fill(out.filter, count, 0);
    fill(out.is_shown, count, 1);
    out.has_transmission = true;
  }
  if (row_.has_sheen && !out.has_sheen) {
    fill(out.sheen, count, 0);
    fill(out.sheen_roughness, count, 1);
    out.has_sheen = true;
  }
  if (row_.has_coat && !out.has_coat) {
    if (!batch_.coat) batch_.coat = std::make_unique<FragmentBatch>();
    fill(out.coat, count, 0);
    FragmentBatch& coat = *batch_.coat;
    coat.geometry.normal = batch_.geometry.normal;
    coat.geometry.to_viewer = batch_.geometry.to_viewer;
    fill(coat.material.base, count, 0);
    fill(coat.material.emissive, count, 0);
    fill(coat.material.metallic, count, 0);
    fill(coat.material.roughness, count, 1);
    coat.coverage.count = count;
    out.has_coat = true;
  }
}

void LayerRun::fill_factors(int begin, int end) {
  begin_layers();
  LayerLanes& out = batch_.layers;
  const auto for_each = [&](bool is_there, const auto& set) {
    for (int i = begin; is_there && i < end; ++i) set(i);
  };
  for_each(row_.has_dielectric, [&](int i) {
    out.is_dielectric[i] = 1;
    out.f0.set(i, m_.specular.color);
    out.f90[i] = m_.specular.factor;
    out.transmission[i] = m_.transmission.factor;
  });
  for_each(row_.has_transmission, [&](int i) { thickness_[i] = m_.volume.thickness; });
  for_each(row_.has_sheen, [&](int i) {
    out.sheen.set(i, m_.sheen.color);
    out.sheen_roughness[i] = m_.sheen.roughness;
  });
  for_each(row_.has_coat, [&](int i) {
    out.coat[i] = m_.clearcoat.factor;
    batch_.coat->material.roughness[i] = m_.clearcoat.roughness;
    batch_.coat->geometry.normal.set(i, batch_.geometry.normal.at(i));
  });
}

/// Whether light leaves a closed volume here, through a back side. The absorption was already applied at the front.
bool LayerRun::is_way_out(int i) const {
  return m_.volume.thickness > 0 && !m_.double_sided && input_.setups[batch_.coverage.triangle[i]].is_backside;
}

glm::vec3 LayerRun::filter_at(int i) const {
  if (is_way_out(i)) return glm::vec3(1);
  const float metal = batch_.material.metallic[i], metallic = metal > 0 ? std::min(metal, 1.0f) : 0.0f;
  const glm::vec3 tint = glm::min(glm::max(glm::vec3(0), batch_.material.base.at(i)), glm::vec3(1));  // 0 for NaN
  glm::vec3 filter = tint * (1 - metallic);
  if (m_.volume.thickness > 0) {
    const float scale = input_.length_scales[input_.setups[batch_.coverage.triangle[i]].instance];
    const float way = std::min(thickness_[i] * scale, 1e30f);
    for (int c = 0; c < 3; ++c) filter[c] *= exp2_of(std::max(row_.absorption[c] * way, -126.0f));
  }
  return filter;
}

void LayerRun::settle(int begin, int end) {
  LayerLanes& out = batch_.layers;
  for (int i = begin; i < end && row_.has_dielectric; ++i)
    out.f0.set(i, glm::min(out.f0.at(i) * row_.straight, glm::vec3(1)) * out.f90[i]);
  for (int i = begin; i < end && row_.has_transmission; ++i) {
    out.filter.set(i, filter_at(i));
    out.is_shown[i] = is_way_out(i) ? 0.0f : 1.0f;
  }
}

MaterialTable::MaterialTable(const Scene& scene)
    : scene_(scene), srgb_(scene.textures.size()), linear_(scene.textures.size()) {
  for (const Instance& instance : scene.instances) length_scales_.push_back(length_scale_of(instance));
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
    for (const TextureUse* use : texture_uses_of(m)) {
      row.has_textures |= use->is_set();
      if (use->is_set() && use->set > 0) row.further_sets |= 1u << use->set;
    }
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
    // Most fragments have the triangle of the one before, which spares a look at the triangle.
    while (end < coverage.count && (coverage.triangle[end] == coverage.triangle[end - 1] || row_at(end) == row)) ++end;
    MaterialRun(*row, input, batch, textures).fill(begin, end, part);
    begin = end;
  }
}

}  // namespace frontmost::shading
