// SPDX-License-Identifier: Apache-2.0
// Shadows of one light: what the light sees, found by the same z-buffer.
#pragma once

#include "frontmost/view.h"
#include "shade/batch.h"

namespace frontmost::shading {

/// What a map holds, as the kernel reads it.
struct ShadowGrid {
  static constexpr int taps = 8;     ///< of the filter along each axis
  static constexpr int block = 4;    ///< texels along each side that share a number of `nearest` and `farthest`
  static constexpr int window = 12;  ///< texels along each side that such numbers are about

  int size = 0;                 ///< texels along each side, a multiple of `block`; 0: everything is lit
  const float* keys = nullptr;  ///< by rows; greater is nearer to the light
  /// The greatest and the least key of the window that begins with each block, by rows of blocks: the filter of
  /// whatever begins in the block stays within it, and most points are before all of it, or behind.
  const float *nearest = nullptr, *farthest = nullptr;
  glm::vec3 to_light{0};                     ///< of spots: against the way that they shine
  glm::vec3 texel_x{0}, texel_y{0}, key{0};  ///< what a step in the world changes
  glm::vec3 at_eye{0};                       ///< texel x, y and key at the eye
  float key_bias = 0, key_slope_bias = 0;
  // Of spots all three are to be divided by `key`, which is depth / near; biases are parts of the key.
  bool is_spot = false;
  glm::vec3 lamp{0};  ///< from the eye
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
  /// Takes what the light sees: of what is visible in its view. Borrows the keys.
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
  void measure_sun(const glm::dvec3& eye);
  void measure_spot(const glm::dvec3& eye);

  View light_;
  ShadowGrid grid_;
  Buffer<float> nearest_, farthest_;
};

}  // namespace frontmost::shading
