// SPDX-License-Identifier: Apache-2.0
#include "shade/materials.h"

#include <algorithm>
#include <cmath>

namespace frontmost::shading {
namespace {

/// The directions on a triangle in which u and v grow, at unit length; zero where the coordinates do not span a plane.
struct TangentFrame {
  glm::vec3 along_u{0}, along_v{0};
};

glm::vec3 unit_or_zero(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && length < 1e300 ? glm::vec3(v / length) : glm::vec3(0);
}

TangentFrame tangent_frame(const TriangleSetup& t, const TexcoordTransform& transform) {
  std::array<glm::dvec2, 3> uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] = glm::dvec2(transform.place(t.texcoord[k]));
  const glm::dvec3 edge1 = glm::dvec3(t.corner[1] - t.corner[0]), edge2 = glm::dvec3(t.corner[2] - t.corner[0]);
  const glm::dvec2 uv1 = uv[1] - uv[0], uv2 = uv[2] - uv[0];
  const double area = uv1.x * uv2.y - uv2.x * uv1.y;
  const double sign = area < 0 ? -1 : 1;
  return {unit_or_zero((edge1 * uv2.y - edge2 * uv1.y) * sign), unit_or_zero((edge2 * uv1.x - edge1 * uv2.x) * sign)};
}

glm::vec3 normalized_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length2 = v.x * v.x + v.y * v.y + v.z * v.z;
  return length2 > 1e-20f && length2 < 1e20f ? v * (1.0f / std::sqrt(length2)) : fallback;
}

/// One run of fragments with the same material.
class MaterialRun {
 public:
  MaterialRun(const MaterialRow& row, const std::vector<TriangleSetup>& setups, FragmentBatch& batch)
      : row_(row), setups_(setups), batch_(batch) {}

  void fill(int begin, int end, MaterialPart part, TextureSampler& sampler) {
    fill_factors(begin, end);
    for (int first = begin; first < end && row_.has_textures(); first += sampled_at_once)
      look_up(first, std::min(first + sampled_at_once, end), part, sampler);
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

  /// Fragments of triangles without texture coordinates look at the origin, as if all their coordinates were 0.
  void look_up(int begin, int end, MaterialPart part, TextureSampler& sampler) {
    Reflectance& out = batch_.material;
    glm::vec4 values[sampled_at_once];
    sampler.begin(batch_.geometry, begin, end);
    const auto sample = [&](const TextureSlot& slot, const auto& use) {
      if (!slot.pyramid) return;
      sampler.sample(*slot.pyramid, slot.transform, values);
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
    if (part != MaterialPart::color)
      sample(row_.normal, [&](int i, const glm::vec4& value) { turn_normal(i, glm::vec3(value) * 2.0f - 1.0f); });
  }

  /// `map`: what the normal map holds, from -1 to 1.
  void turn_normal(int i, const glm::vec3& map) {
    const std::uint16_t triangle = batch_.coverage.triangle[i];
    const TriangleSetup& t = setups_[triangle];
    if (!t.has_texcoord) return;
    if (triangle != framed_) {
      frame_ = tangent_frame(t, row_.normal.transform);
      framed_ = triangle;
    }
    const glm::vec3 n = batch_.geometry.normal.at(i);
    const glm::vec3 u = frame_.along_u - n * glm::dot(n, frame_.along_u);
    const glm::vec3 v = frame_.along_v - n * glm::dot(n, frame_.along_v);
    // Green points up in the picture, against v. The back of a surface has its bumps the other way round.
    const float side = (t.is_backside ? -1.0f : 1.0f) * row_.factors.normal_scale;
    const glm::vec3 turned = normalized_or(u, u) * (map.x * side) - normalized_or(v, v) * (map.y * side) + n * map.z;
    batch_.geometry.normal.set(i, normalized_or(turned, n));
  }

  /// What can be seen without blending is there.
  void settle_alpha(int begin, int end) {
    for (int i = begin; i < end; ++i) {
      float& alpha = batch_.material.alpha[i];
      switch (row_.factors.alpha) {
        case Material::Alpha::opaque: alpha = 1.0f; break;
        case Material::Alpha::mask: alpha = 1.0f; break;  // holes are not seen in the first place
        case Material::Alpha::blend: alpha = alpha > 0 ? std::min(alpha, 1.0f) : 0.0f; break;  // 0 for NaN
      }
    }
  }

  const MaterialRow& row_;
  const std::vector<TriangleSetup>& setups_;
  FragmentBatch& batch_;
  int framed_ = -1;  ///< the triangle that frame_ belongs to
  TangentFrame frame_;
};

bool uses_textures(const Material& m) {
  return m.base_color_texture.is_set() || m.metallic_roughness_texture.is_set() || m.normal_texture.is_set() ||
         m.emissive_texture.is_set() || m.occlusion_texture.is_set();
}

}  // namespace

Material default_material() {
  Material material;
  material.base_color = glm::vec4(0.66f, 0.675f, 0.70f, 1.0f);
  material.roughness = 0.5f;
  return material;
}

MaterialTable::MaterialTable(const Scene& scene)
    : scene_(scene), srgb_(scene.textures.size()), linear_(scene.textures.size()) {
  for (const Material& m : scene.materials) {
    rows_.push_back({m, {}, {}, {}, {}, {}});
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
    is_ready_[i] = true;
    --unready_;
  }
}

TextureSlot MaterialTable::slot(const TextureUse& use, Encoding encoding, const Execution& execution) {
  if (!use.is_set()) return {};
  std::unique_ptr<Pyramid>& pyramid = (encoding == Encoding::srgb ? srgb_ : linear_)[use.texture];
  if (!pyramid) pyramid = std::make_unique<Pyramid>(scene_.textures[use.texture], encoding, execution);
  return {pyramid.get(), TexcoordTransform(use)};
}

void look_up_materials(const MaterialTable& table, MaterialPart part, const std::vector<TriangleSetup>& setups,
                       FragmentBatch& batch, Isa isa) {
  TextureSampler sampler(isa);
  const Coverage& coverage = batch.coverage;
  const auto row_at = [&](int i) { return &table.row_of(setups[coverage.triangle[i]]); };
  for (int begin = 0; begin < coverage.count;) {
    const MaterialRow* const row = row_at(begin);
    int end = begin + 1;
    while (end < coverage.count && row_at(end) == row) ++end;
    MaterialRun(*row, setups, batch).fill(begin, end, part, sampler);
    begin = end;
  }
}

}  // namespace frontmost::shading
