// SPDX-License-Identifier: Apache-2.0
// Sums and products of doubles without rounding, and vectors of them: differences, products and determinants.
//
// A sum of doubles that do not overlap holds any number of bits. For instance, the product 0.1 * 0.1 of two doubles is
// the rounded product plus its rounding error, which is again a double:
//
//   0.1 * 0.1  =  0.010000000000000002  +  (-8.3e-19)       largest term: the value to within rounding, and the sign
//
// Terms are kept smallest first, so the last term decides the sign of the sum. Products use an explicit fma: it
// computes the exact error, with the same bits on every machine.
//
// The sign of a determinant is computed in steps, each taken only if the one before leaves the sign open. Almost all
// signs are decided by the first step:
//
//   doubles, with a bound of their error        |value| > error: the sign of the value
//   pairs of doubles, of twice their length     the same, with a bound of 2^-92
//   two of the vectors along one line           0, as for vertices of a mesh that lie on one line
//   expansions                                  certain
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <initializer_list>
#include <memory>
#include <utility>

namespace frontmost {
namespace detail {

/// A list of doubles. The first few need no allocation: allocating would take half of the time of all exact signs.
class TermList {
 public:
  TermList() = default;
  TermList(const TermList& other) { *this = other; }
  TermList& operator=(const TermList& other) {
    if (this == &other) return *this;
    size_ = 0;
    for (const double term : other) push_back(term);
    return *this;
  }
  ~TermList() = default;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const double* begin() const { return more_ ? more_.get() : few_.data(); }
  [[nodiscard]] const double* end() const { return begin() + size_; }
  [[nodiscard]] double* begin() { return more_ ? more_.get() : few_.data(); }
  [[nodiscard]] double* end() { return begin() + size_; }
  [[nodiscard]] double operator[](std::size_t i) const { return begin()[i]; }
  [[nodiscard]] double& operator[](std::size_t i) { return begin()[i]; }
  [[nodiscard]] double back() const { return begin()[size_ - 1]; }
  void push_back(double term) {
    if (size_ == capacity_) grow();
    begin()[size_++] = term;
  }
  /// Precondition: size <= size().
  void shrink(std::size_t size) { size_ = size; }

 private:
  void grow() {
    std::unique_ptr<double[]> larger(new double[2 * capacity_]);
    std::copy(begin(), end(), larger.get());
    more_ = std::move(larger);
    capacity_ *= 2;
  }

  static constexpr std::size_t kFew = 16;
  std::array<double, kFew> few_;  // set by push_back
  std::unique_ptr<double[]> more_;
  std::size_t size_ = 0, capacity_ = kFew;
};

}  // namespace detail

/// A number as a sum of doubles that do not overlap, smallest first, without zeros. Exact unless something overflows or
/// underflows. An empty sum is zero.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double value) {
    if (value != 0) terms_.push_back(value);
  }
  [[nodiscard]] static Expansion difference(double a, double b) { return sum({a, -b}); }

  /// The sum of some doubles.
  [[nodiscard]] static Expansion sum(std::initializer_list<double> terms) {
    Expansion result;
    for (const double term : terms) result.add(term);
    return result;
  }

  /// -1, 0 or 1: the sign of the largest term.
  [[nodiscard]] int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }
  /// The largest term, which is the value of a sum or product to within two roundings.
  [[nodiscard]] double rounded() const { return terms_.empty() ? 0 : terms_.back(); }

  friend Expansion operator+(Expansion a, const Expansion& b) {
    for (const double term : b.terms_) a.add(term);
    a.compress();
    return a;
  }
  friend Expansion operator-(const Expansion& a) {
    Expansion result = a;
    for (double& term : result.terms_) term = -term;
    return result;
  }
  friend Expansion operator-(const Expansion& a, const Expansion& b) { return a + -b; }
  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion result;
    for (const double s : a.terms_)
      for (const double t : b.terms_) {
        const double product = s * t;
        result.add(std::fma(s, t, -product));
        result.add(product);
      }
    result.compress();
    return result;
  }

 private:
  /// Adds a double without rounding (Shewchuk's Grow-Expansion), and drops terms that are zero.
  void add(double value) {
    std::size_t kept = 0;
    for (const double term : terms_) {
      const double sum = value + term, part = sum - value;
      const double error = (value - (sum - part)) + (term - part);
      if (error != 0) terms_[kept++] = error;
      value = sum;
    }
    terms_.shrink(kept);
    if (value != 0) terms_.push_back(value);
  }

  /// Reduces the sum to the fewest terms: products of sums would otherwise grow without end.
  void compress() {
    if (terms_.size() < 2) return;
    detail::TermList large;  // largest first
    double sum = terms_.back();
    for (std::size_t i = terms_.size() - 1; i-- > 0;) {
      const double next = sum + terms_[i], error = terms_[i] - (next - sum);
      if (error != 0) {
        large.push_back(next);
        sum = error;
      } else {
        sum = next;
      }
    }
    terms_.shrink(0);
    for (std::size_t i = large.size(); i-- > 0;) {
      const double next = large[i] + sum, error = sum - (next - large[i]);
      if (error != 0) terms_.push_back(error);
      sum = next;
    }
    if (sum != 0) terms_.push_back(sum);
  }

  detail::TermList terms_;
};

/// Bounds the error of a dozen roundings, relative to the sum of the terms' absolute values.
inline constexpr double kRounding = 32.0 / 9007199254740992.0;

using ExactVector = std::array<Expansion, 3>;

[[nodiscard]] inline ExactVector difference(const glm::dvec3& a, const glm::dvec3& b) {
  return {Expansion::difference(a.x, b.x), Expansion::difference(a.y, b.y), Expansion::difference(a.z, b.z)};
}

[[nodiscard]] inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline Expansion dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline ExactVector exact(const glm::dvec3& v) { return {Expansion(v.x), Expansion(v.y), Expansion(v.z)}; }

/// A double, and a bound of its error.
struct Bounded {
  double value, error;
};

/// The product n.v with a bound of its error, for a normal with errors. v is exact except for one rounding of each
/// component.
[[nodiscard]] inline Bounded bounded_dot(const glm::dvec3& n, const glm::dvec3& n_error, const glm::dvec3& v) {
  const glm::dvec3 a = glm::abs(v);
  return {glm::dot(n, v), glm::dot(n_error, a) + kRounding * glm::dot(glm::abs(n), a)};
}

/// The product a x b with an error bound for each component. a and b are exact except for one rounding of each
/// component.
struct BoundedNormal {
  glm::dvec3 value, error;

  BoundedNormal() = default;
  BoundedNormal(const glm::dvec3& a, const glm::dvec3& b) : value(glm::cross(a, b)) {
    const glm::dvec3 p = glm::abs(a), q = glm::abs(b);
    error = kRounding * glm::dvec3(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
  }
};

/// The vector from one point to another. It is kept as its two points, so it is not rounded.
struct Leg {
  glm::dvec3 to, from{0};
};

/// The sign of a value with a known error; 2 if the error leaves the sign open. If the error is 0, so is the value:
/// each of its products has a factor of 0.
[[nodiscard]] inline int certain_sign(const Bounded& rounded) {
  if (rounded.value > rounded.error) return 1;
  if (rounded.value < -rounded.error) return -1;
  return rounded.error == 0 ? 0 : 2;
}

namespace detail {

/// The sum high + low, which has twice the bits of a double.
struct DoubleDouble {
  double high, low;
};

[[nodiscard]] inline DoubleDouble exact_difference(double a, double b) {
  const double high = a - b, part = a - high;
  return {high, (a - (high + part)) + (part - b)};
}
[[nodiscard]] inline DoubleDouble product(const DoubleDouble& a, const DoubleDouble& b) {
  const double high = a.high * b.high;
  return {high, std::fma(a.high, b.high, -high) + (a.high * b.low + a.low * b.high)};
}
[[nodiscard]] inline DoubleDouble sum(const DoubleDouble& a, const DoubleDouble& b) {
  const double high = a.high + b.high, part = high - a.high;
  return {high, ((a.high - (high - part)) + (b.high - part)) + (a.low + b.low)};
}

/// The sign of the determinant, or 0 if double-doubles leave the sign open.
[[nodiscard]] inline int sign_by_double_doubles(const Leg& a, const Leg& b, const Leg& c) {
  const Leg* legs[3] = {&a, &b, &c};
  DoubleDouble v[3][3];
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) v[i][axis] = exact_difference(legs[i]->to[axis], legs[i]->from[axis]);
  DoubleDouble all{0, 0};
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
    const DoubleDouble plus = product(v[0][j], v[1][k]), minus = product(v[0][k], v[1][j]);
    all = sum(all, product(sum(plus, {-minus.high, -minus.low}), v[2][i]));
    size += (std::abs(plus.high) + std::abs(minus.high)) * std::abs(v[2][i].high);
  }
  // A product or sum errs by less than 2^-100 of its terms, and there are seventeen of them.
  const double value = all.high + all.low, error = size * 1.6e-28;  // 2^-92
  return value > error ? 1 : value < -error ? -1 : 0;
}

/// Whether two vectors surely lie along one line. False if a component of theirs is not exact as a double.
[[nodiscard]] inline bool are_parallel(const Leg& a, const Leg& b) {
  double v[2][3];
  for (int axis = 0; axis < 3; ++axis) {
    const DoubleDouble of_a = exact_difference(a.to[axis], a.from[axis]),
                       of_b = exact_difference(b.to[axis], b.from[axis]);
    if (of_a.low != 0 || of_b.low != 0) return false;
    v[0][axis] = of_a.high;
    v[1][axis] = of_b.high;
  }
  const auto is_same_product = [](double p, double q, double r, double s) {
    const double product = p * q;
    return product == r * s && std::fma(p, q, -product) == std::fma(r, s, -product);
  };
  return is_same_product(v[0][0], v[1][1], v[0][1], v[1][0]) && is_same_product(v[0][1], v[1][2], v[0][2], v[1][1]) &&
         is_same_product(v[0][2], v[1][0], v[0][0], v[1][2]);
}

}  // namespace detail

/// The sign of the determinant of three vectors, exactly: doubles decide if their rounding cannot matter.
[[nodiscard]] inline int sign_of_determinant(const Leg& a, const Leg& b, const Leg& c) {
  const BoundedNormal normal(a.to - a.from, b.to - b.from);
  const int sign = certain_sign(bounded_dot(normal.value, normal.error, c.to - c.from));
  if (sign != 2) return sign;
  if (const int twice = detail::sign_by_double_doubles(a, b, c)) return twice;
  if (detail::are_parallel(a, b) || detail::are_parallel(b, c) || detail::are_parallel(c, a)) return 0;
  return dot(cross(difference(a.to, a.from), difference(b.to, b.from)), difference(c.to, c.from)).sign();
}

}  // namespace frontmost
