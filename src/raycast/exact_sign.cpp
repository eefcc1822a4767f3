// SPDX-License-Identifier: Apache-2.0
#include "raycast/exact_sign.h"

#include <cmath>
#include <vector>

namespace frontmost::raycast_detail {
namespace {

/// A sum of doubles that do not overlap, least first: exact, whatever is added.
class Expansion {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      // Two-sum: sum + error is part + term, exactly.
      const double sum = term + part, from_part = sum - term;
      const double error = (term - (sum - from_part)) + (part - from_part);
      if (error != 0) parts_[kept++] = error;
      term = sum;
    }
    parts_.resize(kept);
    if (term != 0) parts_.push_back(term);
  }
  /// The last part outweighs all others.
  [[nodiscard]] int sign() const { return parts_.empty() ? 0 : parts_.back() > 0 ? 1 : -1; }

 private:
  std::vector<double> parts_;
};

struct Product {
  double value, error;
};
Product multiply(double a, double b) {
  const double value = a * b;
  return {value, std::fma(a, b, -value)};
}

/// sign * a * b * c, each a sum of two.
struct Term {
  int sign;
  std::size_t a, b, c;  // coordinates
};
constexpr std::array<Term, 6> kTerms{
    {{1, 0, 1, 2}, {1, 1, 2, 0}, {1, 2, 0, 1}, {-1, 0, 2, 1}, {-1, 1, 0, 2}, {-1, 2, 1, 0}}};

void add_product(Expansion& sum, double a, double b, double c) {
  if (a == 0 || b == 0 || c == 0) return;
  const Product ab = multiply(a, b);
  for (const double part : {ab.error, ab.value}) {
    const Product abc = multiply(part, c);
    sum.add(abc.error);
    sum.add(abc.value);
  }
}

int exact_sign(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  Expansion sum;
  for (const Term& t : kTerms)
    for (const double x : {a.low[t.a], a.high[t.a]})
      for (const double y : {b.low[t.b], b.high[t.b]})
        for (const double z : {c.low[t.c], c.high[t.c]}) add_product(sum, t.sign * x, y, z);
  return sum.sign();
}

}  // namespace

ExactVector exact(const glm::vec3& v) { return {{v.x, v.y, v.z}, {}}; }

ExactVector exact_difference(const glm::vec3& b, const glm::vec3& a) {
  ExactVector d;
  for (int i = 0; i < 3; ++i) {
    const double to = b[i], from = a[i], difference = to - from, from_to = difference - to;
    d.high[std::size_t(i)] = difference;
    d.low[std::size_t(i)] = (to - (difference - from_to)) - (from + from_to);
  }
  return d;
}

int determinant_sign(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  const std::array<double, 3>&x = a.high, &y = b.high, &z = c.high;
  double det = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t j = std::size_t(i + 1) % 3, k = std::size_t(i + 2) % 3;
    const double p = y[j] * z[k], q = y[k] * z[j];
    det += x[std::size_t(i)] * (p - q);
    size += std::abs(x[std::size_t(i)]) * (std::abs(p) + std::abs(q));
  }
  // Three roundings of the coordinates and five on the way: less than 16 half units in the last place of the size.
  if (std::abs(det) > size * 0x1p-49) return det > 0 ? 1 : -1;
  return exact_sign(a, b, c);
}

}  // namespace frontmost::raycast_detail
