// SPDX-License-Identifier: Apache-2.0
// The depth of a triangle's plane at a sample: first by bounds, then exactly where bounds do not decide.
//
//   BoundedPlane   doubles, with a bound of their error       |----[ depth ]----|
//   exact_depth()  a fraction of two expansions, compared by multiplication, never divided
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

/// The plane of a triangle in doubles, with bounds of their rounding errors.
class BoundedPlane {
 public:
  BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);
  [[nodiscard]] DepthBounds at(const SampleRay& ray) const;
  /// Whether the exact depth within these bounds of at() is the plane's own, not limited by a corner. False if the
  /// bounds leave that open.
  [[nodiscard]] bool is_within_corners(const DepthBounds& bounds) const {
    return bounds.low > limits_low_.high && bounds.high < limits_high_.low;
  }

 private:
  glm::dvec3 corner_;
  BoundedNormal normal_;
  DepthBounds limits_low_, limits_high_;  // depths of the nearest and of the farthest corner
};

/// Whether all vertices of both triangles lie exactly in one plane.
[[nodiscard]] bool lie_in_one_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b);

/// A fraction with a positive denominator.
struct Fraction {
  Expansion numerator, denominator;

  /// The sign of this minus `other`.
  [[nodiscard]] int compare(const Fraction& other) const {
    return (numerator * other.denominator - other.numerator * denominator).sign();
  }
};

/// The depth of a triangle's plane at a ray, limited to the range of its corners.
[[nodiscard]] Fraction exact_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays,
                                   const SampleRay& ray);

}  // namespace frontmost
