// SPDX-License-Identifier: Apache-2.0
// Planes that are never rounded: they are known by points and vectors as they were given.
//
//            u.to            A plane stands for the points x with ((u x v) . (x - anchor)) = 0. Its
//             /              legs u and v are kept as pairs of points, because their differences
//    anchor  /               would be rounded. So the same question has the same answer whoever
//      +--- u.from           asks it, and answers about several planes never contradict each other:
//       .                    that is what lets the painter cut pieces again and again.
//        . v
#pragma once

#include <array>
#include <limits>

#include "base/exact_vector.h"

namespace frontmost::painter_detail {

/// A point, and how far from it the true one may be.
struct Approximate {
  glm::dvec3 at{0};
  double error = std::numeric_limits<double>::infinity();
};

/// Through `anchor`, along u and v. Its positive side is that of u x v.
class Plane {
 public:
  Plane(const glm::dvec3& anchor, const Leg& u, const Leg& v)
      : anchor_(anchor), u_(u), v_(v), normal_(u.to - u.from, v.to - v.from) {}
  /// Positive on the side from which a, b, c are counter-clockwise.
  [[nodiscard]] static Plane through(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {a, {b, a}, {c, a}};
  }

  /// The side of a point: -1, 0 or 1, exactly.
  [[nodiscard]] int side(const glm::dvec3& x) const {
    const int sign = certain_sign(bounded_dot(normal_.value, normal_.error, x - anchor_));
    return sign != 2 ? sign : side_by_hand(x);
  }
  /// How far on the positive side x lies, in the plane's own unit, where x is known to within a distance `error`.
  [[nodiscard]] Bounded height(const glm::dvec3& x, double error) const;
  /// The same for the lowest corner of a box, known by its centre and the ways from there to its sides.
  [[nodiscard]] Bounded least_height(const glm::dvec3& centre, const std::array<glm::dvec3, 3>& halves,
                                     double error) const;

  /// Where three planes meet.
  [[nodiscard]] static Approximate meeting(const std::array<const Plane*, 3>& planes);
  /// The same to within `error`, or as near as doubles are, whatever the angles. Slow. Precondition: they meet in one
  /// point.
  [[nodiscard]] static Approximate closest_meeting(const std::array<const Plane*, 3>& planes, double error);
  /// The side of the point where three planes meet, exactly. Precondition: they meet in one point.
  [[nodiscard]] int side_of_meeting(const std::array<const Plane*, 3>& planes) const;

 private:
  [[nodiscard]] int side_by_hand(const glm::dvec3& x) const;
  /// Known by the same points.
  [[nodiscard]] bool is_same(const Plane& other) const {
    const auto is_same_leg = [](const Leg& a, const Leg& b) { return a.to == b.to && a.from == b.from; };
    return anchor_ == other.anchor_ && is_same_leg(u_, other.u_) && is_same_leg(v_, other.v_);
  }
  /// side_of_meeting(); 2 where numbers of this kind leave it open.
  template <class Number>
  [[nodiscard]] int sign_of_meeting(const std::array<const Plane*, 3>& planes) const;
  template <class Number>
  [[nodiscard]] static Approximate long_meeting(const std::array<const Plane*, 3>& planes);

  glm::dvec3 anchor_;
  Leg u_, v_;
  BoundedNormal normal_;
};

}  // namespace frontmost::painter_detail
