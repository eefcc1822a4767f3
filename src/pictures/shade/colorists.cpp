// SPDX-License-Identifier: Apache-2.0
#include "shade/colorists.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/srgb.h"
#include "shade/light/layers.h"
#include "shade/prepared_scene.h"

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
  batch.layers.clear();
}

float clamped(float value) { return value > 0 ? (value < 1 ? value : 1.0f) : 0.0f; }  // 0 for NaN
glm::vec3 clamped(const glm::vec3& v) { return {clamped(v.x), clamped(v.y), clamped(v.z)}; }

float fraction(float value) {
  if (!(std::abs(value) < 1e6f)) return 0.0f;
  const float whole = float(int(value));
  return value - (whole > value ? whole - 1.0f : whole);
}

/// 1 stays 1, so that the far edge of a texture differs from its near edge.
float wrapped_texcoord(float value) { return value == 1.0f ? 1.0f : fraction(value); }

/// Whether light that reaches the shading normal would come from behind the triangle, on a surface that is not lifted
/// towards the viewer over the triangle's horizon. An example is the inside of a hollow body, whose wall the light
/// would have to cross. Rays ignore the triangle from which they start, and a shadow map has a bias thicker than the
/// wall.
bool comes_through(const Geometry& g, int i, const glm::vec3& to_light) {
  return glm::dot(g.plane_normal.at(i), to_light) <= 0 && g.smooth_position.at(i) == g.position.at(i);
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

glm::vec3 shown_depth(float depth, float nearest, float farthest) {
  const float range = farthest - nearest;
  const float t = range > 0 ? std::clamp((depth - nearest) / range, 0.0f, 1.0f) : 0.0f;
  return glm::vec3(linear_of_shown(0.95f - 0.85f * t));
}

/// Hues are a golden angle apart, in three rounds of brightness, so that consecutive numbers look different.
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

Lit lit_by(const Lighting& lighting, const ShadedPicture& picture, PreparedScene& scene, const Execution& execution) {
  const Lights lights = picture.options.light.lights;
  std::span<const Light> own;
  if (lights == Lights::file || lights == Lights::both) own = scene.surfaces.scene().lights;
  scene.lights.set(counts_key(lights) && lighting.key.is_on() ? &lighting.key : nullptr, own,
                   picture.input.visible.view.eye());
  scene.shadows.find(picture, scene.lights, execution);
  return {scene.materials, lighting, scene.lights, scene.shadows, execution.isa};
}

void Lit::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::all, setups, batch, isa);
  begin_light(batch);
  add_far(setups, batch);
  if (!lights.near.empty()) add_near(setups, batch);
  if (occlusion) occlusion->darken(batch, isa);
  add_surroundings(lighting.around, batch, isa);
  finish_light(lighting, batch, isa);
  if (batch.layers.has_transmission) let_through(batch, Mirroring::by_view);
}

void Lit::add_far(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  const Geometry& g = batch.geometry;
  bool is_asked[batch_capacity];
  for (std::size_t k = 0; k < lights.far.size(); ++k) {
    const DirectLight& light = lights.far[k].light;
    const bool has_shadows = shadows.has_far(k);
    for (int i = 0; i < batch.coverage.count; ++i) {
      is_asked[i] = glm::dot(g.normal.at(i), light.to_light) > 0;
      batch.shadow[i] = 1;
      if (has_shadows && is_asked[i] && comes_through(g, i, light.to_light)) {
        batch.shadow[i] = 0;
        is_asked[i] = false;
      }
    }
    if (has_shadows) shadows.find_far(k, {setups, is_asked, batch}, isa);
    add_direct_light(light, batch, isa);
  }
}

void Lit::add_near(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  const Geometry& g = batch.geometry;
  const BatchBounds bounds = bounds_of(batch);
  bool is_asked[batch_capacity];
  LampLight arriving;
  for (std::size_t k = 0; k < lights.near.size(); ++k) {
    const Lamp& lamp = lights.near[k].lamp;
    if (!may_reach(lamp, bounds)) continue;
    find_lamp_light(lamp, batch, arriving, isa);
    const bool has_shadows = shadows.has_near(k);
    bool any = false;
    for (int i = 0; i < batch.coverage.count; ++i) {
      const glm::vec3 to_lamp = arriving.to_lamp.at(i);
      is_asked[i] = arriving.part[i] > 0 && glm::dot(g.normal.at(i), to_lamp) > 0;
      if (has_shadows && is_asked[i]) is_asked[i] = !comes_through(g, i, to_lamp);
      batch.shadow[i] = is_asked[i] ? 1.0f : 0.0f;
      any |= is_asked[i];
    }
    if (!any) continue;
    if (has_shadows) shadows.find_near(k, {setups, is_asked, batch}, isa);
    for (int i = 0; i < batch.coverage.count; ++i) batch.shadow[i] *= arriving.part[i];
    add_light_from(arriving.to_lamp, lamp.color, batch, isa);
  }
}

void Flat::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::color, setups, batch, isa);
  for (int i = 0; i < batch.coverage.count; ++i) batch.light.set(i, clamped(batch.material.base.at(i)));
  if (!batch.layers.has_transmission) return;
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, batch.light.at(i) * (1 - batch.layers.transmission[i]));
  let_through(batch, Mirroring::none);
}

void Normals::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
  batch.layers.clear();  // a picture of normals shows the surface of glass
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, linear_of_shown(batch.geometry.normal.at(i) * 0.5f + 0.5f));
}

void RawNormals::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
  for (int i = 0; i < batch.coverage.count; ++i) batch.light.set(i, batch.geometry.normal.at(i));
  make_opaque(batch);
}

void Depths::operator()(const std::vector<TriangleSetup>&, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, shown_depth(glm::dot(batch.geometry.position.at(i), forward), nearest, farthest));
  make_opaque(batch);
}

void Ranges::operator()(const std::vector<TriangleSetup>&, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, shown_depth(glm::length(batch.geometry.position.at(i)), nearest, farthest));
  make_opaque(batch);
}

void Ids::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i)
    batch.light.set(i, linear_of_shown(color_of_object(setups[batch.coverage.triangle[i]].instance)));
  make_opaque(batch);
}

void Texcoords::operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const {
  for (int i = 0; i < batch.coverage.count; ++i) {
    const glm::vec2 uv = batch.geometry.texcoord.value.at(i);
    const bool has = setups[batch.coverage.triangle[i]].has_texcoord[0];
    const glm::vec3 shown = has ? glm::vec3(wrapped_texcoord(uv.x), wrapped_texcoord(uv.y), 0) : glm::vec3(0.25f);
    batch.light.set(i, linear_of_shown(shown));
  }
  make_opaque(batch);
}

}  // namespace frontmost::shading
