// SPDX-License-Identifier: Apache-2.0
#include "shade/colorists.h"

#include <array>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "base/srgb.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {
namespace {

float clamped(float value) { return value > 0 ? (value < 1 ? value : 1.0f) : 0.0f; }  // 0 for NaN
glm::vec3 clamped(const glm::vec3& v) { return {clamped(v.x), clamped(v.y), clamped(v.z)}; }

float linear_of_shown_channel(float value) {
  constexpr int steps = 1285;  // divides 65535
  static const auto table = [] {
    std::array<float, steps + 1> values{};
    for (int i = 0; i <= steps; ++i) values[std::size_t(i)] = linear_of_srgb16(std::uint16_t(i * (65535 / steps)));
    return values;
  }();
  const float t = clamped(value) * float(steps);
  const int i = std::min(int(t), steps - 1);
  const float low = table[std::size_t(i)], high = table[std::size_t(i) + 1];
  return low + (high - low) * (t - float(i));
}

float wrapped_texcoord(float value) {
  if (value == 1.0f) return 1.0f;  // so that the far edge of a texture differs from its near edge
  if (!(std::abs(value) < 1e6f)) return 0.0f;
  const float whole = float(int(value));
  return value - (whole > value ? whole - 1.0f : whole);
}

/// Returns true if light that reaches the shading normal comes from behind the triangle, unless the smooth surface is
/// lifted above the triangle. Inside a hollow body this light would have to cross the wall, but no shadow shows it:
/// rays ignore the triangle from which they start, and the bias of a shadow map is thicker than the wall.
bool comes_through(const Geometry& g, int i, const glm::vec3& to_light) {
  const glm::vec3 lifted = g.smooth_position.at(i), flat = g.position.at(i);
  // Without branches, so that the compiler can use vectors.
  return (glm::dot(g.plane_normal.at(i), to_light) <= 0) & (lifted.x == flat.x) & (lifted.y == flat.y) &
         (lifted.z == flat.z);
}

/// Returns the grey of a depth: bright for the nearest, dark for the farthest.
glm::vec3 shown_depth(float depth, const DepthRange& range) {
  const float size = range.farthest - range.nearest;
  const float t = size > 0 ? std::clamp((depth - range.nearest) / size, 0.0f, 1.0f) : 0.0f;
  return glm::vec3(linear_of_shown_channel(0.95f - 0.85f * t));
}

/// Returns a distinctive colour for an object, as displayed, 0 to 1. Hues are a golden angle apart, in three rounds of
/// brightness, so that consecutive numbers look different.
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

/// Shows opaque surfaces: the light of fragment i is color_at(geometry, i, triangle of the fragment), a linear colour.
template <class ColorAt>
void show_opaque(const std::vector<TriangleSetup>& setups, FragmentBatch& batch, ColorAt color_at) {
  for (int i = 0; i < batch.coverage.count; ++i) {
    batch.light.set(i, color_at(batch.geometry, i, setups[batch.coverage.triangle[i]]));
    batch.material.alpha[i] = 1.0f;
  }
  batch.layers.clear();
}

template <class ColorAt>
FragmentShader::Colorist opaque_colorist(ColorAt color_at) {
  return [color_at](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
    show_opaque(setups, batch, color_at);
  };
}

glm::vec3 shown_texcoord(const Geometry& g, int i, const TriangleSetup& triangle) {
  if (!triangle.has_texcoord[0]) return linear_of_shown(glm::vec3(0.25f));
  const glm::vec2 uv = g.texcoord.value.at(i);
  return linear_of_shown({wrapped_texcoord(uv.x), wrapped_texcoord(uv.y), 0});
}

}  // namespace

glm::vec3 linear_of_shown(const glm::vec3& value) {
  return {linear_of_shown_channel(value.x), linear_of_shown_channel(value.y), linear_of_shown_channel(value.z)};
}

Lit lit_by(const Lighting& lighting, const ShadedPicture& picture, PreparedScene& scene, const Execution& execution) {
  const Lights lights = picture.options.light.lights;
  const bool counts_key = lights == Lights::key || lights == Lights::both;
  std::span<const Light> own;
  if (lights == Lights::file || lights == Lights::both) own = scene.surfaces.scene().lights;
  scene.lights.set(counts_key && lighting.key.is_on() ? &lighting.key : nullptr, own, picture.input.visible.view.eye());
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
    std::fill_n(batch.shadow.values, batch.coverage.count, 1.0f);
    if (shadows.has_shadows(k)) {
      const glm::vec3 to_light = light.to_light;  // a copy, which writes below cannot alias
      for (int i = 0; i < batch.coverage.count; ++i) {
        const bool is_lit = glm::dot(g.normal.at(i), to_light) > 0, is_dark = is_lit & comes_through(g, i, to_light);
        batch.shadow[i] = is_dark ? 0.0f : 1.0f;
        is_asked[i] = is_lit & !is_dark;
      }
      shadows.find_arriving(k, {setups, is_asked, batch}, isa);
    }
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
    const std::size_t number = lights.far.size() + k;
    const bool has_shadows = shadows.has_shadows(number);
    bool any = false;
    for (int i = 0; i < batch.coverage.count; ++i) {
      const glm::vec3 to_lamp = arriving.to_lamp.at(i);
      is_asked[i] = arriving.part[i] > 0 && glm::dot(g.normal.at(i), to_lamp) > 0;
      if (has_shadows && is_asked[i]) is_asked[i] = !comes_through(g, i, to_lamp);
      batch.shadow[i] = is_asked[i] ? 1.0f : 0.0f;
      any |= is_asked[i];
    }
    if (!any) continue;
    if (has_shadows) shadows.find_arriving(number, {setups, is_asked, batch}, isa);
    for (int i = 0; i < batch.coverage.count; ++i) batch.shadow[i] *= arriving.part[i];
    add_direct_light({.color = lamp.color, .directions = &arriving.to_lamp}, batch, isa);
  }
}

FragmentShader::Colorist unlit_colorist(Shading shading, const MaterialTable& materials, Isa isa) {
  if (shading == Shading::flat)
    return [&materials, isa](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
      look_up_materials(materials, MaterialPart::color, setups, batch, isa);
      const bool has_glass = batch.layers.has_transmission;
      for (int i = 0; i < batch.coverage.count; ++i) {
        const glm::vec3 color = clamped(batch.material.base.at(i));
        batch.light.set(i, has_glass ? color * (1 - batch.layers.transmission[i]) : color);
      }
      if (has_glass) let_through(batch, Mirroring::none);
    };
  if (shading == Shading::normals)
    return [&materials, isa](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
      look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
      batch.layers.clear();  // a picture of normals shows the surface of glass
      for (int i = 0; i < batch.coverage.count; ++i)
        batch.light.set(i, linear_of_shown(batch.geometry.normal.at(i) * 0.5f + 0.5f));
    };
  if (shading == Shading::uv) return opaque_colorist(shown_texcoord);
  return opaque_colorist([](const Geometry&, int, const TriangleSetup& triangle) {
    return linear_of_shown(color_of_object(triangle.instance));
  });
}

FragmentShader::Colorist normal_colorist(const MaterialTable& materials, Isa isa) {
  return [&materials, isa](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
    look_up_materials(materials, MaterialPart::normal, setups, batch, isa);
    show_opaque(setups, batch, [](const Geometry& g, int i, const TriangleSetup&) { return g.normal.at(i); });
  };
}

DepthRange depth_range(const Visible& visible, const Execution& execution) {
  // Keys are monotonic in depth, so their extremes suffice.
  DepthRange keys;
  std::mutex mutex;
  constexpr std::size_t samples_at_once = 1u << 16;
  parallel_for(execution, visible.keys.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    DepthRange part;
    for (std::size_t i = begin; i < end; ++i)
      if (visible.primitives[i] != no_primitive) part.include({visible.keys[i], visible.keys[i]});
    const std::lock_guard lock(mutex);
    keys.include(part);
  });
  if (!(keys.nearest <= keys.farthest)) return {0, 0};
  return {depth_of_key(visible.view, keys.farthest), depth_of_key(visible.view, keys.nearest)};
}

FragmentShader::Colorist depth_colorist(const DepthRange& range, const glm::vec3& forward) {
  return opaque_colorist([range, forward](const Geometry& g, int i, const TriangleSetup&) {
    return shown_depth(glm::dot(g.position.at(i), forward), range);
  });
}

FragmentShader::Colorist distance_colorist(const DepthRange& range) {
  return opaque_colorist([range](const Geometry& g, int i, const TriangleSetup&) {
    return shown_depth(glm::length(g.position.at(i)), range);
  });
}

}  // namespace frontmost::shading
