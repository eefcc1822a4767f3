// SPDX-License-Identifier: Apache-2.0
// Sums and products of doubles without rounding.
//
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <cmath>
#include <vector>

namespace frontmost {

/// A number as the sum of doubles that do not overlap, smallest first, without zeros: exact as long as nothing
/// overflows or underflows. Empty is zero.
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

  /// -1, 0 or 1: that of the largest term.
  [[nodiscard]] int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }

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
  /// Grow-Expansion with zeros left out.
  void add(double value) {
    std::size_t kept = 0;
    for (const double term : terms_) {
      const double sum = value + term, part = sum - value;
      const double error = (value - (sum - part)) + (term - part);
      if (error != 0) terms_[kept++] = error;
      value = sum;
    }
    terms_.resize(kept);
    if (value != 0) terms_.push_back(value);
  }

  /// As few terms as there can be: products of sums would grow without end.
  void compress() {
    if (terms_.size() < 2) return;
    std::vector<double> large;  // largest first
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
    terms_.clear();
    for (std::size_t i = large.size(); i-- > 0;) {
      const double next = large[i] + sum, error = sum - (next - large[i]);
      if (error != 0) terms_.push_back(error);
      sum = next;
    }
    if (sum != 0) terms_.push_back(sum);
  }

  std::vector<double> terms_;
};

}  // namespace frontmost
