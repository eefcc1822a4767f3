// SPDX-License-Identifier: Apache-2.0
// The depth of a triangle's plane at a sample: first by bounds, then exactly where bounds do not decide.
//
//   BoundedPlane   doubles, with a bound of their error       |----[ depth ]----|
//   ExactDepth     a fraction of two expansions, compared by multiplication, never divided
//
// Two planes are compared by their bounds first. Bounds overlap at few samples of a picture, where the fractions
// decide; exact comparison therefore costs little more than doubles.
#pragma once

#include <array>

#include "base/exact_vector.h"
#include "frontmost/view.h"

namespace frontmost {

/// The ray of a sample: the point at depth d is origin + d * direction. These doubles are the exact input.
struct SampleRay {
  glm::dvec3 origin, direction;
};

/// The rays of all samples of a view.
class SampleRays {
 public:
  explicit SampleRays(const View& view);
  [[nodiscard]] SampleRay at(int x, int y, const glm::ivec2& offset) const;

  [[nodiscard]] bool is_orthographic() const { return orthographic_; }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
  /// Upper bound of the ratio of distance to depth for unclipped points: at the guard band's corner.
  [[nodiscard]] double widest() const { return widest_; }
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] double far() const { return far_; }

 private:
  bool orthographic_;
  glm::dvec3 eye_, forward_, right_, up_;
  double left_, top_, step_x_, step_y_, near_, far_, widest_;
};

/// An interval that contains a depth.
struct DepthBounds {
  double low, high;
};

/// A plane in doubles, with bounds of their rounding.
class BoundedPlane {
 public:
  BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);
  [[nodiscard]] DepthBounds at(const SampleRay& ray) const;
  /// Whether the exact depth within these bounds of at() is the plane's own, not limited by a corner. False if that is
  /// open.
  [[nodiscard]] bool is_within_corners(const DepthBounds& bounds) const {
    return bounds.low > limits_low_.high && bounds.high < limits_high_.low;
  }

 private:
  /// The depth without the limits of the corners. \returns false if nothing is known.
  bool find_depth(const SampleRay& ray, DepthBounds& bounds) const;

  glm::dvec3 corner_;
  BoundedNormal normal_;
  DepthBounds limits_low_, limits_high_;  // depths of the nearest and of the farthest corner
};

/// Whether two triangles lie in exactly one common plane. False if it is open whether either has an area.
[[nodiscard]] bool share_a_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b);
/// Whether all corners have exactly the same depth. Every point of the triangle then has that depth.
[[nodiscard]] bool has_one_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);

/// A depth as a fraction.
class ExactDepth {
 public:
  ExactDepth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays, const SampleRay& ray);

  /// -1 when `a` is nearer than `b`, 0 when they are equal.
  [[nodiscard]] friend int compare(const ExactDepth& a, const ExactDepth& b) {
    return (a.numerator_ * b.denominator_ - b.numerator_ * a.denominator_).sign();
  }

 private:
  void limit(const Expansion& bound, int side);

  Expansion numerator_, denominator_;  // the denominator is positive
};

}  // namespace frontmost
