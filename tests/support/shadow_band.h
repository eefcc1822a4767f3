// SPDX-License-Identifier: Apache-2.0
// Compares a shadow map with rays to the light, and checks whether the map's texels explain the differences.
//
// The map filters the 8 x 8 texels whose centres lie within 4 of a point, raised a little by a bias that allows for the
// slope of its plane. So if the map and the ray differ, the line through one of those texels, or the point's own raised
// by the bias, must hit something else than the ray: a shadow's edge passes within 4 texels. Lines of sight to the
// triangles themselves check this.
#pragma once

#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "shade/geometry/geometry.h"
#include "shade/light/lighting.h"
#include "support/interpolation.h"
#include "support/key_light_map.h"

namespace frontmost::test {

struct ShadowBand {
  std::size_t asked = 0;      ///< pixels whose plane faces the light
  std::size_t in_shadow = 0;  ///< by rays
  std::size_t differing = 0;  ///< the map is neither wholly lit nor wholly dark like the ray
  std::size_t opposite = 0;   ///< counted pixels where the map gives the opposite
  std::size_t by_bias = 0;    ///< counted pixels whose occluder is no higher than the bias
  std::size_t unexplained = 0;
  double widest = 0;  ///< texels to the nearest differing line, along the worse axis
};

class ShadowBandMeter {
 public:
  ShadowBandMeter(const Surfaces& surfaces, const View& view, const Execution& execution = {})
      : surfaces_(surfaces),
        visible_(zbuffer(surfaces, view, execution)),
        index_(surfaces, execution),
        to_key_(shading::direction_to_key(view, {})),
        map_(light_map(surfaces, visible_, glm::dvec3(to_key_), planes_, execution)) {
    const auto light = shading::view_of_light(visible_, surfaces.bounds(), glm::dvec3(to_key_), execution);
    if (!light) return;
    axes_ = glm::dmat3(light->world_from_eye);
    const Projection& window = light->projection;
    corner_ = light->eye() + window.left * axes_[0] + window.top * axes_[1];
    texel_ = (window.right - window.left) / light->width;
    depth_ = window.clip.far - window.clip.near;
  }

  [[nodiscard]] ShadowBand measure(int stride) const {
    ShadowBand band;
    for (int y = 0; y < visible_.view.height; y += stride)
      for (int x = 0; x < visible_.view.width; x += stride) {
        const PrimitiveId id = visible_.primitives[visible_.index(x, y)];
        if (id != no_primitive) measure({float(x) + 0.5f, float(y) + 0.5f}, id, band);
      }
    return band;
  }

 private:
  static constexpr double kReach = 4;  ///< texels: half the width of the map's filter

  void measure(const glm::vec2& screen, PrimitiveId id, ShadowBand& band) const {
    const ScreenRays rays(visible_.view);
    shading::TriangleSetup setup;
    shading::set_up_plane(setup, rays, surfaces_.corners(id), screen);
    const double cosine = glm::dot(glm::dvec3(setup.plane_normal), glm::dvec3(to_key_));
    if (!(cosine > 0.02)) return;
    ++band.asked;
    const glm::vec3 weights = shading::barycentric(setup, screen.x, screen.y).weight;
    const TrianglePoint point{id, setup.corner_world, weights, glm::vec3(0)};
    std::uint8_t is_lit = 0;
    are_lit(index_, {&point, 1}, to_key_, {&is_lit, 1}, {.threads = 1});
    band.in_shadow += is_lit == 0;
    const glm::vec3 position = shading::interpolate(setup.corner, weights);
    const float by_map = light_at(map_, position, setup.plane_normal);
    if (by_map == float(is_lit)) return;
    ++band.differing;
    band.opposite += by_map == float(1 - is_lit);
    const double slope = std::min(8.0, std::sqrt(1 - cosine * cosine) / cosine);
    const double bias = (0.75 + 5 * slope) * texel_ + 2e-6 * depth_;
    explain(glm::dvec3(position) + rays.eye(), is_lit != 0, bias, band);
  }

  /// Whether nothing blocks the line to the light that passes `shift` texels beside a point, from `bias` on.
  [[nodiscard]] bool is_clear_at(const glm::dvec3& world, const glm::dvec2& shift, double bias) const {
    const glm::dvec3 from =
        world + texel_ * (shift.x * axes_[0] - shift.y * axes_[1]) + (bias + 1e-7 * depth_) * axes_[2];
    return is_clear(index_, Segment{glm::vec3(from), glm::vec3(from + 2.0 * depth_ * axes_[2])});
  }

  void explain(const glm::dvec3& world, bool is_lit, double bias, ShadowBand& band) const {
    if (!is_lit && is_clear_at(world, {0, 0}, bias)) {
      ++band.by_bias;
      return;
    }
    const glm::dvec3 from_corner = world - corner_;
    const glm::dvec2 texel(glm::dot(from_corner, axes_[0]) / texel_, -glm::dot(from_corner, axes_[1]) / texel_);
    double nearest = std::numeric_limits<double>::infinity();
    for (double y = std::ceil(texel.y - kReach - 0.5); y + 0.5 <= texel.y + kReach; ++y)
      for (double x = std::ceil(texel.x - kReach - 0.5); x + 0.5 <= texel.x + kReach; ++x) {
        const glm::dvec2 shift = glm::dvec2(x, y) + 0.5 - texel;
        const double away = std::max(std::abs(shift.x), std::abs(shift.y));
        if (away < nearest && differs_at(world, shift, is_lit, bias)) nearest = away;
      }
    if (nearest <= kReach + kSnapped)
      band.widest = std::max(band.widest, nearest);
    else
      ++band.unexplained;
  }

  /// The z-buffer moves vertices by up to half of 1/256 texel, so lines just beside a texel's centre stand for it as
  /// well.
  static constexpr double kSnapped = 1.0 / 128;

  [[nodiscard]] bool differs_at(const glm::dvec3& world, const glm::dvec2& shift, bool is_lit, double bias) const {
    for (const glm::dvec2& aside :
         {glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(1, -1), glm::dvec2(-1, -1)})
      if (is_clear_at(world, shift + kSnapped * aside, bias) != is_lit) return true;
    return false;
  }

  const Surfaces& surfaces_;
  Visible visible_;
  RayIndex index_;
  glm::vec3 to_key_;
  Visible planes_;  ///< borrowed by the map
  shading::ShadowMap map_;
  glm::dmat3 axes_{1};
  glm::dvec3 corner_{0};  ///< position of the map's first texel
  double texel_ = 1, depth_ = 1;
};

}  // namespace frontmost::test
