// SPDX-License-Identifier: Apache-2.0
// Sums and products of doubles without rounding.
//
// A sum of doubles that do not overlap holds any number of bits. For instance, the product 0.1 * 0.1 of two doubles is
// the rounded product plus its rounding error, which is again a double:
//
//   0.1 * 0.1  =  0.010000000000000002  +  (-8.3e-19)       largest term: the value to within rounding, and the sign
//
// Terms are kept smallest first, so the last term decides the sign of the sum. Products use an explicit fma: it
// computes the exact error, with the same bits on every machine.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
  [[nodiscard]] static Expansion difference(double a, double b) {
    Expansion result(a);
    result.add(-b);
    return result;
  }

  /// -1, 0 or 1: the sign of the largest term.
  [[nodiscard]] int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }
  /// The largest term: the value to within two roundings of sums and products.
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
  /// Grow-Expansion, without zeros.
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

}  // namespace frontmost
