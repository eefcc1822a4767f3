// SPDX-License-Identifier: Apache-2.0
// The depth of a triangle's plane at a sample: quickly within bounds, and exactly where bounds do not decide.
//
//   BoundedPlane   doubles, with a bound of their error       |----[ depth ]----|
//   ExactDepth     a fraction of two expansions, compared by multiplication, never divided
//
// Two planes are compared by their bounds first. Where these overlap, which happens at a few samples of a picture, the
// fractions decide; so "exact" costs little more than doubles.
#pragma once

#include <array>

#include "base/exact_vector.h"
#include "frontmost/view.h"

namespace frontmost {

/// The ray of a sample: the point at depth d is origin + d * direction. Its doubles are what "exact" starts from.
struct SampleRay {
  glm::dvec3 origin, direction;
};

/// What all samples of a view have in common.
class SampleRays {
 public:
  explicit SampleRays(const View& view);
  [[nodiscard]] SampleRay at(int x, int y, const glm::ivec2& offset) const;

  [[nodiscard]] bool is_orthographic() const { return orthographic_; }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
  /// The greatest distance from the eye, by depth, of what is snapped as it is: at the guard band's corner.
  [[nodiscard]] double widest() const { return widest_; }
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] double far() const { return far_; }

 private:
  bool orthographic_;
  glm::dvec3 eye_, forward_, right_, up_;
  double left_, top_, step_x_, step_y_, near_, far_, widest_;
};

/// A depth lies within.
struct DepthBounds {
  double low, high;
};

/// A plane in doubles, with what their rounding may amount to.
class BoundedPlane {
 public:
  BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);
  [[nodiscard]] DepthBounds at(const SampleRay& ray) const;
  /// Whether the exact depth that at() has these bounds of is the plane's own, which no corner limits. False where that
  /// is open.
  [[nodiscard]] bool is_within_corners(const DepthBounds& bounds) const {
    return bounds.low > limits_low_.high && bounds.high < limits_high_.low;
  }

 private:
  /// Without the limits of the corners. \returns false where nothing is known.
  bool find_depth(const SampleRay& ray, DepthBounds& bounds) const;

  glm::dvec3 corner_;
  BoundedNormal normal_;
  DepthBounds limits_low_, limits_high_;  // of the nearest and of the farthest corner
};

/// Whether two triangles lie in one plane, and neither in several. False where that is open of either's area.
[[nodiscard]] bool share_a_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b);
/// Whether all corners have one depth, exactly: then every point of the triangle has.
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

  Expansion numerator_, denominator_;  // the latter positive
};

}  // namespace frontmost
