// SPDX-License-Identifier: Apache-2.0
// Planes that are never rounded: they are stored as given points and vectors.
//
//            u.to            A plane is the set of points x with ((u x v) . (x - anchor)) = 0. Its legs
//             /              u and v are kept as pairs of points, because their differences would be
//    anchor  /               rounded. So the same question always has the same answer, and answers
//      +--- u.from           about several planes never contradict each other. This lets the painter
//       .                    cut pieces again and again.
//        . v
#pragma once

#include <array>
#include <limits>

#include "base/exact_vector.h"

namespace frontmost::painter_detail {

/// A point, and the greatest distance of the true point from it.
struct Approximate {
  glm::dvec3 at{0};
  double error = std::numeric_limits<double>::infinity();
};

/// The plane through `anchor` along u and v. Its positive side is that of u x v.
class Plane {
 public:
  Plane(const glm::dvec3& anchor, const Leg& u, const Leg& v)
      : anchor_(anchor), u_(u), v_(v), normal_(u.to - u.from, v.to - v.from) {}
  /// The plane through a, b, c, positive on the side from which they are counter-clockwise.
  [[nodiscard]] static Plane through(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {a, {b, a}, {c, a}};
  }

  /// The side of a point: -1, 0 or 1, exactly.
  [[nodiscard]] int side(const glm::dvec3& x) const {
    const int sign = certain_sign(bounded_dot(normal_.value, normal_.error, x - anchor_));
    return sign != 2 ? sign : side_by_hand(x);
  }
  /// Height of x on the positive side, in the plane's own unit. x is known to within a distance `error`.
  [[nodiscard]] Bounded height(const glm::dvec3& x, double error) const;
  /// Height of the lowest corner of a box, given by its centre and the vectors from there to its sides.
  [[nodiscard]] Bounded least_height(const glm::dvec3& centre, const std::array<glm::dvec3, 3>& halves,
                                     double error) const;

  /// The point where three planes meet.
  [[nodiscard]] static Approximate meeting(const std::array<const Plane*, 3>& planes);
  /// The point where three planes meet, to within `error` or as near as doubles are, whatever the angles. Slow.
  /// Precondition: the planes meet in one point.
  [[nodiscard]] static Approximate closest_meeting(const std::array<const Plane*, 3>& planes, double error);
  /// The side of the point where three planes meet, exactly. Precondition: the planes meet in one point.
  [[nodiscard]] int side_of_meeting(const std::array<const Plane*, 3>& planes) const;

 private:
  [[nodiscard]] int side_by_hand(const glm::dvec3& x) const;
  /// Whether both planes are stored as the same points.
  [[nodiscard]] bool is_same(const Plane& other) const {
    const auto is_same_leg = [](const Leg& a, const Leg& b) { return a.to == b.to && a.from == b.from; };
    return anchor_ == other.anchor_ && is_same_leg(u_, other.u_) && is_same_leg(v_, other.v_);
  }
  /// side_of_meeting(), or 2 if numbers of this kind leave it open.
  template <class Number>
  [[nodiscard]] int sign_of_meeting(const std::array<const Plane*, 3>& planes) const;
  template <class Number>
  [[nodiscard]] static Approximate long_meeting(const std::array<const Plane*, 3>& planes);

  glm::dvec3 anchor_;
  Leg u_, v_;
  BoundedNormal normal_;
};

}  // namespace frontmost::painter_detail
