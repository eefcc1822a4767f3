// SPDX-License-Identifier: Apache-2.0
// The shadow map of one light: the light's view, drawn by the same z-buffer as pictures.
#pragma once

#include "frontmost/view.h"
#include "shade/batch.h"

namespace frontmost::shading {

/// The data of a map in the form that the kernel reads.
struct ShadowGrid {
  static constexpr int taps = 8;     ///< of the filter along each axis
  static constexpr int block = 4;    ///< texels per side that share a number of `nearest` and `farthest`
  static constexpr int window = 12;  ///< texels per side from which such a number is computed

  int size = 0;                 ///< texels per side, a multiple of `block`; 0: everything is lit
  const float* keys = nullptr;  ///< row by row; greater is nearer to the light
  /// The greatest and the least key in the window that begins at each block, by rows of blocks. A filter that begins in
  /// the block stays within the window, and most points are before all of the window, or behind.
  const float *nearest = nullptr, *farthest = nullptr;
  glm::vec3 to_light{0};                     ///< for spots, opposite to their axis
  glm::vec3 texel_x{0}, texel_y{0}, key{0};  ///< changes per unit step in the world
  glm::vec3 at_eye{0};                       ///< texel x, y and key at the eye
  float key_bias = 0, key_slope_bias = 0;
  // For spots, all three are still to be divided by `key`, which is depth / near; biases are fractions of the key.
  bool is_spot = false;
  glm::vec3 lamp{0};  ///< from the eye
};

/// Points in world axes from the eye, and normals of the flat surface there. Arrays have room for loops over whole
/// vectors.
struct ShadowPoints {
  static constexpr int most = batch_room;
  const float *x, *y, *z;
  const float *normal_x, *normal_y, *normal_z;
  int count;  ///< at most batch_capacity
};

/// Initially everything is lit. Maps drawn one after another reuse the memory.
class ShadowMap {
 public:
  /// Takes the light's view as drawn. Borrows the keys.
  void draw(const Visible& seen_by_light, const Execution& execution);
  /// Sets the origin of points. Precondition: something was drawn.
  void measure_from(const glm::dvec3& eye);
  /// Makes everything lit.
  void clear() { grid_.size = 0; }
  /// The view that was drawn.
  [[nodiscard]] const View& view() const { return light_; }
  [[nodiscard]] const ShadowGrid& grid() const { return grid_; }

  /// Sets light[i] of each point that `is_asked` to the share of the light that arrives there, 0 to 1. Shadow edges are
  /// a few texels wide.
  void find_light(const ShadowPoints& points, const bool* is_asked, float* light, Isa isa) const;

 private:
  void measure_sun(const glm::dvec3& eye);
  void measure_spot(const glm::dvec3& eye);

  View light_;
  ShadowGrid grid_;
  Buffer<float> nearest_, farthest_;
};

}  // namespace frontmost::shading
