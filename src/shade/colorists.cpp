// SPDX-License-Identifier: Apache-2.0
#include "shade/colorists.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/srgb.h"

namespace frontmost::shading {
namespace {

constexpr int kSteps = 1285;  ///< divides 65535

const std::array<float, kSteps + 1>& shown_table() {
  static const auto table = [] {
    std::array<float, kSteps + 1> values{};
    for (int i = 0; i <= kSteps; ++i) values[std::size_t(i)] = linear_of_srgb16(std::uint16_t(i * (65535 / kSteps)));
    return values;
  }();
  return table;
}

void make_opaque(FragmentBatch& batch) {
  for (int i = 0; i < batch.coverage.count; ++i) {
    batch.material.alpha[i] = 1.0f;
  }
}

float clamped(float value) { return value > 0 ? (value < 1 ? value : 1.0f) : 0.0f; }  // 0 for NaN
glm::vec3 clamped(const glm::vec3& v) { return {clamped(v.x), clamped(v.y), clamped(v.z)}; }

float fraction(float value) {
  if (!(std::abs(value) < 1e6f)) return 0.0f;
  const float whole = float(int(value));
  return value - (whole > value ? whole - 1.0f : whole);
}

/// 1 stays 1, so that the far edge of a texture looks unlike its near edge.
float wrapped_texcoord(float value) { return value == 1.0f ? 1.0f : fraction(value); }

/// True where light that the normal faces would come from behind the triangle, and nothing says that the surface bulges
/// towards the viewer there, over the triangle's horizon: as on the inside of a hollow body, whose wall the light would
/// have to pass through. Rays leave the triangle that they start from out of account, and would not see it; nor does a
/// map, whose bias is thicker than the wall (and which lets light through beside it for the same reason).
bool comes_through(const Geometry& g, int i, const glm::vec3& to_key) {
  return glm::dot(g.plane_normal.at(i), to_key) <= 0 && g.smooth_position.at(i) == g.position.at(i);
}

}  // namespace

float linear_of_shown(float value) {
  const float t = clamped(value) * float(kSteps);
  const int i = std::min(int(t), kSteps - 1);
  const auto& table = shown_table();
  const float low = table[std::size_t(i)], high = table[std::size_t(i) + 1];
  return low + (high - low) * (t - float(i));
}

glm::vec3 linear_of_shown(const glm::vec3& value) {
  return {linear_of_shown(value.x), linear_of_shown(value.y), linear_of_shown(value.z)};
}

/// Hues a golden angle apart, in three rounds of brightness, so that neighbouring numbers look nothing alike.
glm::vec3 color_of_object(std::uint32_t object) {
  const float hue = float(object * 0x9E3779B9u >> 8) / float(1 << 24) * 6.0f;
  const float value = 0.95f - 0.18f * float(object % 3), saturation = 0.75f - 0.2f * float(object / 3 % 2);
  const auto part = [&](float shift) {
    float h = hue + shift;
    if (h >= 6.0f) h -= 6.0f;
    const float ramp = std::clamp(std::min(h, 4.0f - h), 0.0f, 1.0f);
    return value * (1.0f - saturation * ramp);
  };
  return {part(5.0f), part(3.0f), part(1.0f)};
}

void Lit::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::all, setups, batch, isa);
  const Geometry& g = batch.geometry;
  const int count = batch.coverage.count;
  bool faces_key[batch_capacity];
  for (int i = 0; i < count; ++i) {
    faces_key[i] = glm::dot(g.normal.at(i), lighting.to_key) > 0;
    batch.shadow[i] = 1;
    if ((map || rays) && faces_key[i] && comes_through(g, i, lighting.to_key)) {
      batch.shadow[i] = 0;
      faces_key[i] = false;
    }
  }
  const Lane3 &at = g.smooth_position, &normal = g.plane_normal;
  if (map) {
    map->find_light({at.x.values, at.y.values, at.z.values, normal.x.values, normal.y.values, normal.z.values, count},
                    faces_key, batch.shadow.values, isa);
  }
  if (rays) rays->find_light(setups, faces_key, batch);
  light_batch(lighting, batch, isa);
}

void Flat::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::color, setups, batch, isa);
  for (int i = 0; i < batch.coverage.count; ++i) batch.light.set(i, clamped(batch.material.base.at(i)));
}

void Normals::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, linear_of_shown(batch.geometry.normal.at(i) * 0.5f + 0.5f));
}

void RawNormals::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
  for (int i = 0; i < batch.coverage.count; ++i) batch.light.set(i, batch.geometry.normal.at(i));
  make_opaque(batch);
}

void Depths::operator()(const std::vector<TriangleSetup>&, FragmentBatch& batch) const {
  const float range = farthest - nearest;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const float depth = glm::dot(batch.geometry.position.at(i), forward);
    const float t = range > 0 ? std::clamp((depth - nearest) / range, 0.0f, 1.0f) : 0.0f;
    batch.light.set(i, glm::vec3(linear_of_shown(0.95f - 0.85f * t)));
  }
  make_opaque(batch);
}

void Ids::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, linear_of_shown(color_of_object(setups[batch.coverage.triangle[i]].instance)));
  make_opaque(batch);
}

void Texcoords::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i) {
    const glm::vec2 uv = batch.geometry.texcoord.at(i);
    const bool has = setups[batch.coverage.triangle[i]].has_texcoord;
    const glm::vec3 shown = has ? glm::vec3(wrapped_texcoord(uv.x), wrapped_texcoord(uv.y), 0) : glm::vec3(0.25f);
    batch.light.set(i, linear_of_shown(shown));
  }
  make_opaque(batch);
}

}  // namespace frontmost::shading
