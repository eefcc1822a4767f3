// SPDX-License-Identifier: Apache-2.0
// Lines of sight of a view: exact signs tell what lies left or right of them, before or behind them.
//
//   eye                p
//    o - - - - - - - - + - - - -          EyePlane: through the eye and the edge from p to q. turn(x) tells on
//     \ - - - - - - - -| - - - - x        which side of the edge x is seen.
//      \               |
//       ` - - - - - - -+ - - - -          FacePlane: through a triangle. height(x) tells on which side of it x lies.
//                      q
//
// Both signs together decide what hides what, and both are signs of determinants of the stored coordinates: nothing is
// projected, so nothing is rounded. The values that come with the signs are rounded; they tell where something is,
// never whether it is seen.
#pragma once

#include "base/exact_vector.h"
#include "frontmost/view.h"

namespace frontmost {

/// A double whose sign is certain.
struct Signed {
  double value = 0;
  int sign = 0;
};
[[nodiscard]] inline Signed with_sign_of_value(double value) { return {value, value > 0 ? 1 : value < 0 ? -1 : 0}; }

/// Makes planes that contain lines of sight, and finds the places of points on the screen.
class Sight {
 public:
  /// Precondition: validate(view) passes.
  explicit Sight(const View& view);

  /// The plane through the eye (parallel projection: along the view) and two points.
  class EyePlane {
   public:
    /// Positive if p, q and x turn left as seen from the eye. `slack` bounds the error of each coordinate of x. If
    /// `slack` is above 0, the sign is 0 where slack or rounding leaves it open.
    [[nodiscard]] Signed turn(const glm::dvec3& x, double slack = 0) const;

   private:
    friend class Sight;
    const Sight* sight_ = nullptr;
    glm::dvec3 p_, q_;
    BoundedNormal normal_;
  };
  [[nodiscard]] EyePlane plane_through(const glm::dvec3& p, const glm::dvec3& q) const;

  /// 1 for a triangle that is seen counter-clockwise, -1 for clockwise, 0 for edge-on.
  [[nodiscard]] int facing(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    return plane_through(a, b).turn(c).sign;
  }

  /// The position in eye space, with the planar distance in place of z.
  [[nodiscard]] glm::dvec3 in_eye(const glm::dvec3& position) const;
  /// \returns x and y in pixels, and the planar distance as z. Precondition in perspective: the point is not in the
  /// plane of the eye.
  [[nodiscard]] glm::dvec3 to_screen(const glm::dvec3& in_eye) const;
  /// The weight, for interpolation on the screen, of the point that lies a share t of the way between two points of eye
  /// space.
  [[nodiscard]] double to_weight(const glm::dvec3& from, const glm::dvec3& to, double t) const {
    return is_parallel_ ? 1 : from.z + (to.z - from.z) * t;
  }
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] double far() const { return far_; }
  [[nodiscard]] bool is_parallel() const { return is_parallel_; }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  /// The viewing direction, of unit length.
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }

 private:
  glm::dvec3 eye_, forward_, right_, up_;
  glm::dvec2 scale_, offset_;  ///< to pixels
  double near_, far_;
  bool is_parallel_;
};

/// The plane of a triangle.
class FacePlane {
 public:
  FacePlane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
      : a_(a), b_(b), c_(c), normal_(b - a, c - a) {}
  /// Positive on the side from which a, b, c are counter-clockwise. `slack` as for turn().
  [[nodiscard]] Signed height(const glm::dvec3& x, double slack = 0) const;
  [[nodiscard]] const glm::dvec3& normal() const { return normal_.value; }

 private:
  glm::dvec3 a_, b_, c_;
  BoundedNormal normal_;
};

}  // namespace frontmost
