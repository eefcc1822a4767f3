// SPDX-License-Identifier: Apache-2.0
// Shadows of the key light: what the light sees, found by the same z-buffer.
#pragma once

#include <optional>

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"
#include "shade/shadow/shadow_filter.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// The view of the light: along -to_light at what `visible` shows, with room for whatever else lies within `bounds` and
/// may stand between. None where nothing is visible, or there is nothing to throw a shadow.
[[nodiscard]] std::optional<View> view_of_light(const Visible& visible, const Box& bounds, const glm::dvec3& to_light,
                                                const Execution& execution);

/// At first everything is lit. Maps that are drawn one after another use the same memory.
class ShadowMap {
 public:
  /// Takes what the light sees: of what is visible in view_of_light().
  void draw(const Visible& seen_by_light, const Execution& execution);
  /// Points are measured from here. Precondition: something was drawn.
  void measure_from(const glm::dvec3& eye);
  /// From now on everything is lit.
  void clear() { size_ = 0; }
  /// The view that was drawn; of no pixels where everything is lit.
  [[nodiscard]] const View& view() const { return light_; }

  /// The part of the light that arrives at a point, 0 to 1, with soft edges a few texels wide.
  /// `position` in world axes from the eye of `visible`; `plane_normal` of the flat surface there.
  [[nodiscard]] float light_at(const glm::vec3& position, const glm::vec3& plane_normal) const;

 private:
  static constexpr int taps = shadow_taps;

  void find_nearest(const Buffer<float>& rows, const Execution& execution);
  void transpose(const Buffer<float>& rows, const Execution& execution);
  [[nodiscard]] float filtered(const glm::vec2& texel, float key) const;

  ShadowFilter filter_ = nullptr;
  View light_;
  int size_ = 0;           ///< texels along each side; 0: no map
  Buffer<float> keys_;     ///< by columns; greater is nearer to the light
  Buffer<float> nearest_;  ///< the greatest of the filter's keys, by its first texel: most points are lit by all
  glm::vec3 to_light_{0};
  glm::vec3 texel_x_{0}, texel_y_{0}, key_{0};  ///< what a step in the world changes
  glm::vec3 at_eye_{0};                         ///< texel x, y and key at the eye
  float key_bias_ = 0, key_slope_bias_ = 0;
};

}  // namespace frontmost::shading
