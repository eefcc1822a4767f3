// SPDX-License-Identifier: Apache-2.0
#include "shade/light/lighting.h"

#include <cmath>

#include "scene/turn.h"

namespace frontmost::shading {
namespace {

/// The forward direction of an environment, perpendicular to `up`.
glm::dvec3 ahead_of(const View& view, const glm::dvec3& up, bool turns_with_camera) {
  const auto levelled = [&](const glm::dvec3& v) { return v - up * glm::dot(v, up); };
  // The direction in which NamedView::front looks.
  const glm::dvec3 front = std::abs(up.z) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  if (!turns_with_camera) return front;
  // Where the view is straight up or down, the picture's top is ahead, or behind.
  const glm::dvec3 forward = levelled(view.forward());
  constexpr double least = 1e-3;
  if (glm::dot(forward, forward) > least) return unit(forward);
  return unit(levelled(glm::dot(view.forward(), up) < 0 ? view.up() : -view.up()));
}

/// The axes of an environment: x right, y up, z backwards.
glm::dmat3 world_from_environment(const View& view, const glm::dvec3& up, const LightOptions& options, bool turns) {
  const glm::dvec3 ahead = ahead_of(view, up, turns), right = glm::cross(ahead, up);
  const double c = std::cos(options.environment_angle), s = std::sin(options.environment_angle);
  return {right * c + ahead * s, up, right * s - ahead * c};
}

/// The moments' polynomial, rotated to world axes.
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

}  // namespace frontmost::shading
