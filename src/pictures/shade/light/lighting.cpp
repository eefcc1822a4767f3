// SPDX-License-Identifier: Apache-2.0
#include "shade/light/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/turn.h"
#include "shade/light/albedo.h"

namespace frontmost::shading {
namespace {

/// Returns the forward direction of an environment, perpendicular to `up`.
glm::dvec3 ahead_of(const View& view, const glm::dvec3& up, bool turns_with_camera) {
  const auto levelled = [&](const glm::dvec3& v) { return v - up * glm::dot(v, up); };
  // The direction in which NamedView::front looks.
  const glm::dvec3 front = std::abs(up.z) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  if (!turns_with_camera) return front;
  // If the camera looks straight down, the top of the picture is ahead; if it looks straight up, the top is behind.
  const glm::dvec3 forward = levelled(view.forward());
  constexpr double least = 1e-3;
  if (glm::dot(forward, forward) > least) return unit(forward);
  return unit(levelled(glm::dot(view.forward(), up) < 0 ? view.up() : -view.up()));
}

/// Returns the axes of an environment: x right, y up, z backwards.
glm::dmat3 world_from_environment(const View& view, const glm::dvec3& up, const LightOptions& options, bool turns) {
  const glm::dvec3 ahead = ahead_of(view, up, turns), right = glm::cross(ahead, up);
  const double c = std::cos(options.environment_angle), s = std::sin(options.environment_angle);
  return {right * c + ahead * s, up, right * s - ahead * c};
}

/// Returns the moments' polynomial, rotated to world axes.
IrradiancePolynomial polynomial_of(const IrradianceMoments& moments, const glm::dmat3& world_from_environment) {
  IrradiancePolynomial p;
  for (int k = 0; k < 3; ++k) {
    const IrradianceMoments::Moments& m = moments.channels[std::size_t(k)];
    const glm::dvec3 linear = 2.0 * (world_from_environment * m.first);
    const glm::dmat3 q = 1.875 * (world_from_environment * m.second * glm::transpose(world_from_environment));
    p.constant[k] = float(m.mean);
    p.x[k] = float(linear.x);
    p.y[k] = float(linear.y);
    p.z[k] = float(linear.z);
    p.xx[k] = float(q[0][0]);
    p.yy[k] = float(q[1][1]);
    p.zz[k] = float(q[2][2]);
    p.xy[k] = float(q[0][1] + q[1][0]);
    p.yz[k] = float(q[1][2] + q[2][1]);
    p.zx[k] = float(q[2][0] + q[0][2]);
  }
  return p;
}

constexpr std::size_t kMostLights = 4096;

/// Returns the radiance of a white diffuse surface that faces the light, for lamps at distance 1.
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

/// Returns the mirrored share by Schlick's approximation.
float mirrored(float f0, float f90, float cosine) {
  const float x = std::clamp(1 - cosine, 0.0f, 1.0f), x2 = x * x;
  return f0 + (f90 - f0) * (x2 * x2 * x);
}

float cosine_of_view(const Geometry& g, int i) { return std::max(glm::dot(g.normal.at(i), g.to_viewer.at(i)), 1e-3f); }

float greatest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

/// Returns the share of light that fibres leave for the surface below.
float below_sheen(const FragmentBatch& batch, int i) {
  const float roughness = shown_sheen_roughness(batch.layers.sheen_roughness[i]);
  return 1 - greatest(batch.layers.sheen.at(i)) * sheen_albedo().at(cosine_of_view(batch.geometry, i), roughness);
}

/// Returns the share of light that a varnish leaves for the surface below.
float below_coat(const FragmentBatch& batch, int i) {
  return 1 - batch.layers.coat[i] * mirrored(0.04f, 1, cosine_of_view(batch.coat->geometry, i));
}

/// Returns the share of light that neither the surface nor a layer over it mirrors.
float passes_surface(const FragmentBatch& batch, int i) {
  const LayerLanes& layers = batch.layers;
  const float cosine = cosine_of_view(batch.geometry, i);
  glm::vec3 taken;
  for (int c = 0; c < 3; ++c) taken[c] = mirrored(layers.f0.at(i)[c], layers.f90[i], cosine);
  float passes = 1 - std::min(greatest(taken), 1.0f);
  if (layers.has_sheen) passes *= below_sheen(batch, i);
  if (layers.has_coat) passes *= below_coat(batch, i);
  return passes;
}

}  // namespace

void check_light(const LightOptions& options) {
  const auto refuse = [](const char* place, const char* reason) {
    throw Error(ErrorCode::bad_argument, place, reason);
  };
  constexpr double most_stops = 32, most_intensity = 1e6;
  if (!std::isfinite(options.environment_angle)) refuse("shade: environment angle", "must be finite");
  if (!(std::abs(options.exposure) <= most_stops)) refuse("shade: exposure", "must be -32 to 32 stops");
  if (options.intensity && !(*options.intensity >= 0 && *options.intensity <= most_intensity))
    refuse("shade: light intensity", "must be 0 to 1000000");
  if (!options.direction) return;
  const double length2 = glm::dot(*options.direction, *options.direction);
  if (!(length2 >= 1e-200 && length2 <= 1e200)) refuse("shade: light direction", "must have a length, 1e-100 to 1e100");
}

glm::vec3 direction_to_key(const View& view, const LightOptions& options) {
  if (options.direction) return glm::vec3(unit(*options.direction));
  return glm::vec3(glm::normalize(-0.48 * view.right() + 0.68 * view.up() - 0.72 * view.forward()));
}

double key_intensity(const LightOptions& options) {
  if (options.intensity) return *options.intensity;
  return options.environment && options.environment->picture() ? 0.0 : 1.0;
}

Lighting lighting_for(const View& view, Axis up, const LightOptions& options, const Environment& environment) {
  Lighting lighting;
  lighting.key.to_light = direction_to_key(view, options);
  lighting.key.color *= float(key_intensity(options));
  lighting.exposure = float(std::exp2(options.exposure));
  lighting.tone_mapping = options.tone_mapping;
  if (prefiltered(environment).is_dark) return lighting;
  const glm::dmat3 turn = world_from_environment(view, direction(up), options, environment.turns_with_camera());
  lighting.around.environment = &prefiltered(environment);
  lighting.around.world_from_environment = glm::mat3(turn);
  lighting.around.irradiance = polynomial_of(prefiltered(environment).irradiance, turn);
  return lighting;
}

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
  // Tests a sphere around the box against the cone, by the distance of the sphere's centre from the cone. A cone is at
  // most a half-space.
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

void begin_light(FragmentBatch& batch) {
  batch.light = batch.material.emissive;
  if (batch.layers.has_sheen) batch.layers.sheen_light = {};
  if (batch.layers.has_coat) batch.coat->light = {};
}

void lay_layers_over(FragmentBatch& batch) {
  const LayerLanes& layers = batch.layers;
  const int count = batch.coverage.count;
  for (int i = 0; i < count && layers.has_sheen; ++i)
    batch.light.set(i, batch.light.at(i) * below_sheen(batch, i) + layers.sheen_light.at(i));
  for (int i = 0; i < count && layers.has_coat; ++i)
    batch.light.set(i, batch.light.at(i) * below_coat(batch, i) + batch.coat->light.at(i) * layers.coat[i]);
}

void let_through(FragmentBatch& batch, Mirroring mirroring) {
  // The least opacity where light is mirrored. It is invisible, and the division by it stays finite.
  constexpr float least = 0x1p-20f;
  const LayerLanes& layers = batch.layers;
  for (int i = 0; i < batch.coverage.count; ++i) {
    float& alpha = batch.material.alpha[i];
    batch.alphas.set(i, glm::vec3(alpha));
    const bool is_shown = layers.is_shown[i] > 0;
    if (is_shown && !(layers.transmission[i] > 0)) continue;
    const float passes = is_shown && mirroring == Mirroring::by_view ? passes_surface(batch, i) : 1.0f;
    const glm::vec3 through = layers.filter.at(i) * (layers.transmission[i] * passes);
    const glm::vec3 sent = is_shown ? batch.light.at(i) * alpha : glm::vec3(0);
    glm::vec3 hidden = glm::clamp((1.0f - through) * alpha, 0.0f, 1.0f);
    if (sent != glm::vec3(0)) hidden = glm::max(hidden, glm::vec3(least));
    alpha = (hidden.x + hidden.y + hidden.z) * (1.0f / 3);
    batch.alphas.set(i, hidden);
    batch.light.set(i, alpha > 0 ? sent / alpha : glm::vec3(0));
  }
}

void hide_by_highlights(FragmentBatch& batch) {
  for (int i = 0; i < batch.coverage.count; ++i) {
    const float brightest = greatest(batch.light.at(i));
    if (!(brightest > 1)) continue;
    batch.light.set(i, batch.light.at(i) / brightest);
    batch.alphas.set(i, glm::min(batch.alphas.at(i) * brightest, glm::vec3(1)));
    batch.material.alpha[i] = std::min(batch.material.alpha[i] * brightest, 1.0f);
  }
}

}  // namespace frontmost::shading
