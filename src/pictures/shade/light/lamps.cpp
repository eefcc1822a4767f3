// SPDX-License-Identifier: Apache-2.0
#include "shade/light/lamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frontmost::shading {
namespace {

constexpr std::size_t kMostLights = 4096;

/// The radiance of a white diffuse surface that faces the light; for lamps, at distance 1.
glm::vec3 color_of(const Light& light) {
  // Brighter lights would overflow floats in products with the mirrored share of smooth surfaces.
  constexpr double brightest = 1e12;
  glm::vec3 color;
  for (int k = 0; k < 3; ++k)
    color[k] = float(std::min(double(light.color[k]) * light.intensity / std::numbers::pi, brightest));
  return color;
}

Lamp lamp_of(const Light& light, const glm::dvec3& eye) {
  Lamp lamp;
  lamp.position = glm::vec3(glm::dvec3(light.world_from_light[3]) - eye);
  lamp.axis = -glm::vec3(light.world_from_light[2]);
  lamp.color = color_of(light);
  // Keeps squares of the range finite and above 0.
  if (light.range) lamp.range = float(std::clamp(*light.range, 1e-18, 1e18));
  if (light.kind != Light::Kind::spot) return lamp;
  // Avoids a division by zero for cones without a soft edge, in the same way as the extension's reference code.
  const double inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
  lamp.cosine_outer = float(outer);
  lamp.cone_scale = float(1 / std::max(0.001, inner - outer));
  return lamp;
}

}  // namespace

BatchBounds bounds_of(const FragmentBatch& batch) {
  const int count = batch.coverage.count;
  const auto range = [&](const Lane& lane) { return std::minmax_element(lane.values, lane.values + count); };
  const auto [low_x, high_x] = range(batch.geometry.position.x);
  const auto [low_y, high_y] = range(batch.geometry.position.y);
  const auto [low_z, high_z] = range(batch.geometry.position.z);
  return {{*low_x, *low_y, *low_z}, {*high_x, *high_y, *high_z}};
}

bool may_reach(const Lamp& lamp, const BatchBounds& bounds) {
  constexpr float spare = 1.0001f;  // margin for rounding
  const glm::vec3 nearest = glm::clamp(lamp.position, bounds.low, bounds.high) - lamp.position;
  if (lamp.range > 0 && glm::dot(nearest, nearest) > lamp.range * lamp.range * spare) return false;
  if (lamp.cone_scale == 0) return true;
  // Tests a sphere around the box against a cone of at most a half-space, by the distance of its centre from the cone.
  const glm::vec3 centre = 0.5f * (bounds.low + bounds.high) - lamp.position;
  const float radius = 0.5f * glm::length(bounds.high - bounds.low), size = glm::length(centre);
  const float along = glm::dot(centre, lamp.axis);
  const float across = std::sqrt(std::max(size * size - along * along, 0.0f));
  const float sine_outer = std::sqrt(std::max(1 - lamp.cosine_outer * lamp.cosine_outer, 0.0f));
  return across * lamp.cosine_outer - along * sine_outer <= radius + (spare - 1) * (size + radius);
}

void PictureLights::set(const DirectLight* key, std::span<const Light> lights, const glm::dvec3& eye) {
  far.clear();
  near.clear();
  if (lights.size() > kMostLights)
    throw Error(ErrorCode::limit_exceeded, "shade",
                std::to_string(lights.size()) + " lights are more than " + std::to_string(kMostLights));
  if (key) far.push_back({*key, nullptr});
  for (const Light& light : lights) {
    const glm::vec3 color = color_of(light);
    if (color == glm::vec3(0)) continue;
    if (light.kind == Light::Kind::sun)
      far.push_back({{.to_light = glm::vec3(light.world_from_light[2]), .color = color}, &light});
    else
      near.push_back({lamp_of(light, eye), &light});
  }
}

}  // namespace frontmost::shading
