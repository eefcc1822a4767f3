// SPDX-License-Identifier: Apache-2.0
// Numbers of twice the length of doubles, with a bound on their error. They stand between doubles, which leave the
// sides of many corners open, and expansions, which are much slower.
//
// A number is kept as a sum of two doubles, together with the sum of the absolute values of its terms. Its error is at
// most a share of that sum, whatever cancels in the number itself. So the sign of a polynomial is certain if its value
// exceeds the share; only otherwise are expansions needed.
#pragma once

#include <cmath>

#include "base/exact_vector.h"

namespace frontmost::painter_detail {

/// A number, and the sum of the absolute values of its terms, of which its error is a share. For polynomials of up to
/// the ninth degree in differences of doubles.
class Twice {
 public:
  Twice() = default;
  [[nodiscard]] static Twice difference(double a, double b) {
    const detail::DoubleDouble value = detail::exact_difference(a, b);
    return {value, std::abs(value.high) * (1 + 1e-15)};
  }

  /// A product or sum errs by less than 2^-100 of its size, and shares of factors add up to less than 2^-95 after nine
  /// factors, their sums and the sums of the products. Beyond 10^+-250 doubles may have underflowed or overflowed, so
  /// the error is unbounded.
  [[nodiscard]] Bounded bounded() const {
    const bool is_within_range = size_ > 1e-250 && size_ < 1e250;
    return {value_.high + value_.low,
            is_within_range ? size_ * 1.6e-28 : std::numeric_limits<double>::infinity()};  // 2^-92
  }
  /// The sign, or 2 if the error leaves it open.
  [[nodiscard]] int certain_sign() const {
    const Bounded rounded = bounded();
    return rounded.value > rounded.error ? 1 : rounded.value < -rounded.error ? -1 : 2;
  }

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

/// Vectors of such numbers, or of expansions.
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

}  // namespace frontmost::painter_detail
