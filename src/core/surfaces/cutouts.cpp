// SPDX-License-Identifier: Apache-2.0
#include "surfaces/cutouts.h"

#include <bitset>

#include "surfaces/cluster_set.h"

namespace frontmost {
namespace {

CutoutPattern pattern_of(const Scene& scene, const Material& material) {
  CutoutPattern pattern;
  pattern.alpha = material.base_color.a;
  pattern.cutoff = material.alpha_cutoff;
  if (!material.base_color_texture.is_set()) return pattern;
  const Texture& texture = scene.textures[material.base_color_texture.texture];
  if (texture.pixels.empty()) return pattern;
  pattern.transform = TexcoordTransform(material.base_color_texture);
  pattern.width = texture.width;
  pattern.height = texture.height;
  pattern.wrap_u = texture.wrap_u;
  pattern.wrap_v = texture.wrap_v;
  pattern.nearest = texture.nearest;
  // Only alphas are copied, a quarter of the texture.
  pattern.alphas.reserve(texture.pixels.size());
  for (const glm::u8vec4& pixel : texture.pixels) pattern.alphas.push_back(pixel.a);
  return pattern;
}

/// The values of a triangle's vertices, or `none` if the mesh has no such attribute.
template <class T>
std::array<T, 3> corner_values(const Mesh& mesh, const Attribute<T>* attribute, std::uint32_t triangle, const T& none) {
  if (!attribute || attribute->empty()) return {none, none, none};
  const glm::uvec3& corners = mesh.corners(*attribute, triangle);
  return {attribute->values[corners.x], attribute->values[corners.y], attribute->values[corners.z]};
}

float mix(float a, float b, float t) { return a + (b - a) * t; }

template <class T>
T weighted(const std::array<T, 3>& corner, const glm::vec3& weight) {
  return corner[0] * weight.x + corner[1] * weight.y + corner[2] * weight.z;
}

}  // namespace

float CutoutPattern::texture_alpha(const glm::vec2& texcoord) const {
  const auto at = [&](int x, int y) { return float(alphas[std::size_t(y) * std::size_t(width) + std::size_t(x)]); };
  if (nearest) return at(texel_of(texcoord.x, width, wrap_u), texel_of(texcoord.y, height, wrap_v)) / 255.0f;
  const TexelPair x = texel_pair(texcoord.x, width, wrap_u), y = texel_pair(texcoord.y, height, wrap_v);
  const float above = mix(at(x.first, y.first), at(x.second, y.first), x.fraction);
  const float below = mix(at(x.first, y.second), at(x.second, y.second), x.fraction);
  return mix(above, below, y.fraction) / 255.0f;
}

bool CutoutPattern::is_hole(const glm::vec2& texcoord, float vertex_alpha) const {
  float value = alpha * vertex_alpha;
  if (width > 0) value *= texture_alpha(transform.place(texcoord));
  return !(value >= cutoff);  // NaN is a hole
}

bool CutoutTriangle::is_hole(const glm::vec3& weight) const {
  return pattern->is_hole(weighted(texcoord, weight), weighted(alpha, weight));
}

bool CutoutTriangle::is_hole_at(const glm::dvec3& point) const {
  // Weights are ratios of areas in the triangle's own plane.
  const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  return is_hole(normalized_weights({glm::dot(normal, glm::cross(b - point, c - point)),
                                     glm::dot(normal, glm::cross(c - point, a - point)),
                                     glm::dot(normal, glm::cross(a - point, b - point))}));
}

glm::vec3 normalized_weights(const glm::dvec3& values) {
  const double total = values.x + values.y + values.z;
  const glm::dvec3 turned = total < 0 ? -values : values;
  const glm::dvec3 inside = glm::max(turned, glm::dvec3(0));
  const double sum = inside.x + inside.y + inside.z;
  // Equal weights for an edge-on triangle, or NaN.
  if (!(sum > 0 && sum <= std::numeric_limits<double>::max())) return glm::vec3(1.0f / 3);
  return glm::vec3(inside / sum);
}

std::shared_ptr<Cutouts> Cutouts::of(const Scene& scene, const std::vector<PrimitiveId>& first_primitives) {
  auto cutouts = std::make_shared<Cutouts>();
  cutouts->patterns_ = std::make_shared<std::vector<CutoutPattern>>();
  bool any = false;
  for (const Material& material : scene.materials) {
    // In other alpha modes, alpha either blends or is ignored.
    const bool cuts = material.alpha == Material::Alpha::mask;
    cutouts->cuts_.push_back(cuts);
    cutouts->patterns_->push_back(cuts ? pattern_of(scene, material) : CutoutPattern{});
    any = any || cuts;
  }
  // Most scenes have no cutouts, and samples of them need no test.
  if (!any) return nullptr;
  cutouts->words_.resize(first_primitives.back() / 64 + 1);
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    cutouts->add_mesh(scene, scene.instances[i], first_primitives[i]);
  // There is a bit for each triangle and a sum for each word, so an id's index is found by counting bits. A table would
  // take four bytes for every triangle of the scene.
  std::uint32_t before = 0;
  for (Word& word : cutouts->words_) {
    word.before = before;
    before += std::uint32_t(std::bitset<64>(word.bits).count());
  }
  return cutouts->triangles_.empty() ? nullptr : cutouts;
}

void Cutouts::add_mesh(const Scene& scene, const Instance& instance, PrimitiveId first) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const ToWorld world(instance.world_from_mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t material = mesh.material_of(t);
    if (material >= cuts_.size() || !cuts_[material]) continue;
    const std::uint32_t set = scene.materials[material].base_color_texture.set;
    CutoutTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = world(mesh.positions[mesh.triangles[t][int(k)]]);
    triangle.texcoord = corner_values(mesh, mesh.texcoord_set(set), t, glm::vec2(0));
    const std::array<glm::vec4, 3> colors = corner_values(mesh, &mesh.colors, t, glm::vec4(1));
    triangle.alpha = {colors[0].a, colors[1].a, colors[2].a};
    triangle.pattern = &(*patterns_)[material];
    words_[(first + t) / 64].bits |= std::uint64_t(1) << ((first + t) % 64);
    triangles_.push_back(triangle);
  }
}

void Cutouts::move(const Mesh& mesh, const glm::dmat4& world_from_mesh, PrimitiveId first) {
  const ToWorld world(world_from_mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (has(first + t))
      for (std::size_t k = 0; k < 3; ++k)
        triangles_[place_of(first + t)].corner[k] = world(mesh.positions[mesh.triangles[t][int(k)]]);
}

std::size_t Cutouts::place_of(PrimitiveId id) const {
  const Word& word = words_[id / 64];
  const std::uint64_t lower = word.bits & ((std::uint64_t(1) << (id % 64)) - 1);
  return word.before + std::bitset<64>(lower).count();
}

const CutoutTriangle& Cutouts::operator[](PrimitiveId id) const { return triangles_[place_of(id)]; }

std::size_t Cutouts::byte_count() const {
  std::size_t bytes = words_.size() * sizeof(Word) + triangles_.size() * sizeof(CutoutTriangle);
  for (const CutoutPattern& pattern : *patterns_) bytes += sizeof pattern + pattern.alphas.size();
  return bytes;
}

}  // namespace frontmost
