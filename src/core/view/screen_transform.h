// SPDX-License-Identifier: Apache-2.0
// From world space to the snapped screen: the one definition of a vertex's place, for every method and kernel.
//
// With d = position - eye, the homogeneous screen position is X = x_row . d + x_offset, Y and D likewise, and W = D
// (perspective) or 1 (parallel). X / W is in 1/256 pixel from the centre of the image, x right, y down; D is the planar
// distance. Rows and offsets are floats, evaluated as ((a*dx + b*dy) + c*dz) + offset without fused operations, so that
// scalar code and every kernel give the same bits. The offsets contain the part of the eye's position that floats lose,
// so far from the origin only the model's own rounding remains.
#pragma once

#include <array>
#include <cmath>

#include "frontmost/view.h"

namespace frontmost {

/// Sub-pixel units in a pixel.
inline constexpr int kSubPixels = 256;
/// Vertices are snapped within +-8192 pixels of the image's centre; triangles that reach beyond are clipped.
inline constexpr std::int32_t kGuardBand = 8192 * kSubPixels;

struct ScreenTransform {
  /// 2^126: the greatest distance whose reciprocal a float holds to full precision.
  static constexpr float farthest = 8.507059173e37f;

  std::array<float, 3> eye, x_row, y_row, d_row;
  float x_offset, y_offset, d_offset;
  bool orthographic;
  float near, far;                  ///< planar distances; an infinite far plane stands at `farthest`
  float inverse_range;              ///< 1 / (far - near) in parallel projection
  std::int32_t centre_x, centre_y;  ///< the image's centre from its top left corner, in 1/256 pixel

  /// Precondition: validate(view) passes.
  explicit ScreenTransform(const View& view);
};

/// A vertex on the screen, in 1/256 pixel from the centre of the image, with its depth key.
struct ScreenVertex {
  std::int32_t x, y;
  float key;
};

/// A vertex before the divide.
struct HomogeneousVertex {
  float x, y, d;
};

inline HomogeneousVertex transform(const ScreenTransform& t, const glm::vec3& position) {
  const float dx = position.x - t.eye[0], dy = position.y - t.eye[1], dz = position.z - t.eye[2];
  return {((t.x_row[0] * dx + t.x_row[1] * dy) + t.x_row[2] * dz) + t.x_offset,
          ((t.y_row[0] * dx + t.y_row[1] * dy) + t.y_row[2] * dz) + t.y_offset,
          ((t.d_row[0] * dx + t.d_row[1] * dy) + t.d_row[2] * dz) + t.d_offset};
}

/// True if the vertex lies between near and far and within the guard band, so that it can be snapped as it is. False
/// for NaN.
inline bool is_plain(const ScreenTransform& t, const HomogeneousVertex& v) {
  // Far away the product overflows. Without the limit, an infinite coordinate would count as within an infinite reach.
  const float reach = std::fmin(float(kGuardBand) * (t.orthographic ? 1.0f : v.d), std::numeric_limits<float>::max());
  return v.d >= t.near && v.d <= t.far && std::abs(v.x) <= reach && std::abs(v.y) <= reach;
}

/// The snapped vertex. Precondition: is_plain().
inline ScreenVertex snap(const ScreenTransform& t, const HomogeneousVertex& v) {
  if (t.orthographic) {
    const float key = (t.far - v.d) * t.inverse_range;
    return {int(std::nearbyint(v.x)), int(std::nearbyint(v.y)), std::fmin(std::fmax(key, 0.0f), 1.0f)};
  }
  const float inverse = 1.0f / v.d;
  return {int(std::nearbyint(v.x * inverse)), int(std::nearbyint(v.y * inverse)), std::fmin(t.near * inverse, 1.0f)};
}

}  // namespace frontmost
