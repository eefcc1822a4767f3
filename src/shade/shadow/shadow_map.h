// SPDX-License-Identifier: Apache-2.0
// Shadows of the key light: what the light sees, found by the same z-buffer.
#pragma once

#include <optional>

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"
#include "shade/batch.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// The view of the light: along -to_light at what `visible` shows, with room for whatever else lies within `bounds` and
/// may stand between. None where nothing is visible, or there is nothing to throw a shadow.
[[nodiscard]] std::optional<View> view_of_light(const Visible& visible, const Box& bounds, const glm::dvec3& to_light,
                                                const Execution& execution);

/// What a map holds, as the kernel reads it.
struct ShadowGrid {
  static constexpr int taps = 8;   ///< of the filter along each axis
  static constexpr int block = 4;  ///< texels along each side that share a number of `nearest`

  int size = 0;                    ///< texels along each side, a multiple of `block`; 0: everything is lit
  const float* keys = nullptr;     ///< by rows; greater is nearer to the light
  const float* nearest = nullptr;  ///< the greatest key of each block, by rows of blocks: most points are before all
  glm::vec3 to_light{0};
  glm::vec3 texel_x{0}, texel_y{0}, key{0};  ///< what a step in the world changes
  glm::vec3 at_eye{0};                       ///< texel x, y and key at the eye
  float key_bias = 0, key_slope_bias = 0;
};

/// Points in world axes from the eye, and normals of the flat surface there. Whoever reads several at a time may go on
/// behind the last.
struct ShadowPoints {
  static constexpr int most = batch_room;
  const float *x, *y, *z;
  const float *normal_x, *normal_y, *normal_z;
  int count;  ///< at most batch_capacity
};

/// At first everything is lit. Maps that are drawn one after another use the same memory.
class ShadowMap {
 public:
  /// Takes what the light sees: of what is visible in view_of_light(). Borrows its keys.
  void draw(const Visible& seen_by_light, const Execution& execution);
  /// Points are measured from here. Precondition: something was drawn.
  void measure_from(const glm::dvec3& eye);
  /// From now on everything is lit.
  void clear() { grid_.size = 0; }
  /// The view that was drawn.
  [[nodiscard]] const View& view() const { return light_; }
  [[nodiscard]] const ShadowGrid& grid() const { return grid_; }

  /// Sets light[i] of each point that `is_asked` to the part of the light that arrives there, 0 to 1, with soft edges a
  /// few texels wide.
  void find_light(const ShadowPoints& points, const bool* is_asked, float* light, Isa isa) const;

 private:
  View light_;
  ShadowGrid grid_;
  Buffer<float> nearest_;
};

}  // namespace frontmost::shading
