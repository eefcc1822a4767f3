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
  /// The ray through a place of the picture, in 1/256 pixel.
  [[nodiscard]] SampleRay at(const glm::ivec2& place) const;

  [[nodiscard]] bool is_orthographic() const { return orthographic_; }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
  /// Upper bound of the ratio of distance to depth for unclipped points: at the guard band's corner.
  [[nodiscard]] double widest() const { return widest_; }
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] double far() const { return far_; }

 private:
  View view_;
  bool orthographic_ = view_.projection.orthographic;
  glm::dvec3 eye_ = view_.eye(), forward_ = view_.forward(), right_ = view_.right(), up_ = view_.up();
  double left_ = view_.projection.left, step_x_ = (view_.projection.right - view_.projection.left) / view_.width;
  double top_ = view_.projection.top, step_y_ = (view_.projection.top - view_.projection.bottom) / view_.height;
  double near_, far_, widest_;
};

/// The place of a sample in the picture, in 1/256 pixel. Samples are numbered as in Visible.
[[nodiscard]] glm::ivec2 place_of_sample(const View& view, std::size_t sample);

/// An interval that contains a depth.
struct DepthBounds {
  double low, high;
};

/// Bounds of above / below, limited to what lies between `least` and `greatest`; the whole range between them if
/// `below` is 0 as far as doubles can tell.
[[nodiscard]] inline DepthBounds bounded_quotient(const Bounded& above, const Bounded& below, const DepthBounds& least,
                                                  const DepthBounds& greatest) {
  // The test is written so that NaN passes it.
  if (!(std::abs(below.value) > 4 * below.error)) return {least.low, greatest.high};
  const double value = above.value / below.value;
  const double error = (above.error + std::abs(value) * below.error) / (std::abs(below.value) - below.error) +
                       kRounding * std::abs(value);
  return {std::min(std::max(value - error, least.low), greatest.low),
          std::min(std::max(value + error, least.high), greatest.high)};
}

/// A plane in doubles, with bounds of their rounding.
class BoundedPlane {
 public:
  BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);
  [[nodiscard]] DepthBounds at(const SampleRay& ray) const;
  /// Whether the exact depth within these bounds of at() is surely the plane's own, not limited by a corner.
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

/// A fraction. Its denominator is positive, or 0.
struct Fraction {
  Expansion numerator, denominator;

  Fraction(const Expansion& above, const Expansion& below)
      : numerator(below.sign() < 0 ? -above : above), denominator(below.sign() < 0 ? -below : below) {}
  /// The sign of this minus `other`.
  [[nodiscard]] int compare(const Fraction& other) const {
    return (numerator * other.denominator - other.numerator * denominator).sign();
  }
};

/// The depth of a triangle's plane at a ray. The denominator is 0 if the ray lies in the plane or misses it.
[[nodiscard]] Fraction exact_plane_depth(const std::array<glm::dvec3, 3>& corners, const SampleRay& ray);
/// The depth of the nearest (extreme 1) or the farthest (-1) corner, limited to the near and far planes.
[[nodiscard]] Expansion exact_corner_depth(const std::array<glm::dvec3, 3>& corners, const SampleRays& rays,
                                           int extreme);
/// The depth of a triangle's plane at a ray, limited to the range of its corners.
[[nodiscard]] Fraction exact_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays,
                                   const SampleRay& ray);

}  // namespace frontmost
