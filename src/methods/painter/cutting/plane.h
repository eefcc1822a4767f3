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
#include <cmath>
#include <limits>

#include "base/exact_vector.h"

namespace frontmost::painter_detail {

/// A number with twice the digits of a double: a sum of two doubles. The sum of the absolute values of its terms is
/// stored, too, because the error is a share of that sum, whatever cancels in the number itself. Serves polynomials of
/// up to the ninth degree in differences of doubles. Doubles leave the sides of many corners open, and expansions are
/// much slower; these numbers stand between them.
class Twice {
 public:
  Twice() = default;
  [[nodiscard]] static Twice difference(double a, double b) {
    const detail::DoubleDouble value = detail::exact_difference(a, b);
    return {value, std::abs(value.high) * (1 + 1e-15)};
  }

  /// Returns the value with an error bound. A product or sum errs by less than 2^-100 of its size. After nine factors,
  /// their sums and the sums of the products, these errors add up to less than 2^-95. Beyond 10^+-250 doubles may have
  /// underflowed or overflowed, so the error is unbounded.
  [[nodiscard]] Bounded bounded() const {
    const bool is_within_range = size_ > 1e-250 && size_ < 1e250;
    return {value_.high + value_.low,
            is_within_range ? size_ * 1.6e-28 : std::numeric_limits<double>::infinity()};  // 2^-92
  }
  /// The sign, or 2 if the error leaves it open.
  [[nodiscard]] int certain_sign() const { return frontmost::certain_sign(bounded()); }

  friend Twice operator+(const Twice& a, const Twice& b) {
    return {detail::sum(a.value_, b.value_), a.size_ + b.size_};
  }
  friend Twice operator-(const Twice& a, const Twice& b) {
    return {detail::sum(a.value_, {-b.value_.high, -b.value_.low}), a.size_ + b.size_};
  }
  friend Twice operator*(const Twice& a, const Twice& b) {
    return {detail::product(a.value_, b.value_), a.size_ * b.size_};
  }

 private:
  Twice(const detail::DoubleDouble& value, double size) : value_(value), size_(size) {}
  detail::DoubleDouble value_{0, 0};
  double size_ = 0;
};

/// Vectors of Twice, or of expansions.
template <class Number>
using LongVector = std::array<Number, 3>;

template <class Number>
[[nodiscard]] LongVector<Number> difference_of(const glm::dvec3& a, const glm::dvec3& b) {
  return {Number::difference(a.x, b.x), Number::difference(a.y, b.y), Number::difference(a.z, b.z)};
}
template <class Number>
[[nodiscard]] LongVector<Number> cross_of(const LongVector<Number>& a, const LongVector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Number>
[[nodiscard]] Number dot_of(const LongVector<Number>& a, const LongVector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A plane n.x = d, where x is relative to some point.
template <class Number>
struct LongPlane {
  LongVector<Number> n;
  Number d;
};

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
  /// Returns the height of x above the plane, times the length of the normal. x is known to within a distance `error`.
  [[nodiscard]] Bounded height(const glm::dvec3& x, double error) const;
  /// Returns the height of the lowest corner of a box, which is given by its centre and the vectors from there to its
  /// sides.
  [[nodiscard]] Bounded least_height(const glm::dvec3& centre, const std::array<glm::dvec3, 3>& halves,
                                     double error) const;

  /// The point where three planes meet.
  [[nodiscard]] static Approximate meeting(const std::array<Plane, 3>& planes);
  /// The point where three planes meet, to within `error` or as near as doubles are, whatever the angles. Slow.
  /// Precondition: the planes meet in one point.
  [[nodiscard]] static Approximate closest_meeting(const std::array<Plane, 3>& planes, double error);
  /// The side of the point where three planes meet, exactly. Precondition: the planes meet in one point.
  [[nodiscard]] int side_of_meeting(const std::array<Plane, 3>& planes) const;
  /// The plane in numbers of this kind, relative to the anchor of another plane. Defined in plane.cpp, for use there.
  template <class Number>
  [[nodiscard]] LongPlane<Number> in_full(const Plane& other) const;

 private:
  [[nodiscard]] int side_by_hand(const glm::dvec3& x) const;
  /// Returns whether both planes are stored as the same points.
  [[nodiscard]] bool is_same(const Plane& other) const {
    const auto is_same_leg = [](const Leg& a, const Leg& b) { return a.to == b.to && a.from == b.from; };
    return anchor_ == other.anchor_ && is_same_leg(u_, other.u_) && is_same_leg(v_, other.v_);
  }
  /// side_of_meeting(), or 2 if numbers of this kind leave it open.
  template <class Number>
  [[nodiscard]] int sign_of_meeting(const std::array<Plane, 3>& planes) const;
  template <class Number>
  [[nodiscard]] static Approximate long_meeting(const std::array<Plane, 3>& planes);

  glm::dvec3 anchor_;
  Leg u_, v_;
  BoundedNormal normal_;
};

}  // namespace frontmost::painter_detail
