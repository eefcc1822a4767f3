// SPDX-License-Identifier: Apache-2.0
// Geometry in fractions: slow, but exact.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <glm/glm.hpp>

namespace frontmost::test {

using Rational = boost::multiprecision::cpp_rational;

struct RationalVector {
  Rational x, y, z;
  explicit RationalVector(const glm::dvec3& v) : x(v.x), y(v.y), z(v.z) {}
  RationalVector(Rational a, Rational b, Rational c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
};
inline RationalVector operator-(const RationalVector& a, const RationalVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline RationalVector operator+(const RationalVector& a, const RationalVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline RationalVector operator*(const Rational& s, const RationalVector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Rational dot(const RationalVector& a, const RationalVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline RationalVector cross(const RationalVector& a, const RationalVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace frontmost::test
