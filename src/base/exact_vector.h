// SPDX-License-Identifier: Apache-2.0
// Vectors of expansions: differences, products and determinants of doubles without rounding.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "base/expansion.h"

namespace frontmost {

/// What a dozen roundings may amount to, as a share of the sum of the terms' absolute values.
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

/// A double, and by how much it may be wrong.
struct Bounded {
  double value, error;
};

/// n.v for a normal with errors; v exact but for a rounding of each component.
[[nodiscard]] inline Bounded bounded_dot(const glm::dvec3& n, const glm::dvec3& n_error, const glm::dvec3& v) {
  const glm::dvec3 a = glm::abs(v);
  return {glm::dot(n, v), glm::dot(n_error, a) + kRounding * glm::dot(glm::abs(n), a)};
}

/// a x b of vectors that are exact but for a rounding of each component, and by how much each of its own may be wrong.
struct BoundedNormal {
  glm::dvec3 value, error;

  BoundedNormal() = default;
  BoundedNormal(const glm::dvec3& a, const glm::dvec3& b) : value(glm::cross(a, b)) {
    const glm::dvec3 p = glm::abs(a), q = glm::abs(b);
    error = kRounding * glm::dvec3(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
  }
};

/// The vector from one point to another, neither rounded.
struct Leg {
  glm::dvec3 to, from{0};
};

/// The sign of a value whose error is known: 2 where that leaves it open. Without any error the value is 0: each of its
/// products has a factor that is.
[[nodiscard]] inline int certain_sign(const Bounded& rounded) {
  if (rounded.value > rounded.error) return 1;
  if (rounded.value < -rounded.error) return -1;
  return rounded.error == 0 ? 0 : 2;
}

/// The sign of the determinant of three vectors, exactly: doubles decide where their rounding cannot matter.
[[nodiscard]] inline int sign_of_determinant(const Leg& a, const Leg& b, const Leg& c) {
  const BoundedNormal normal(a.to - a.from, b.to - b.from);
  const int sign = certain_sign(bounded_dot(normal.value, normal.error, c.to - c.from));
  if (sign != 2) return sign;
  return dot(cross(difference(a.to, a.from), difference(b.to, b.from)), difference(c.to, c.from)).sign();
}

}  // namespace frontmost
