// SPDX-License-Identifier: Apache-2.0
// Points and normals of a patch, from Bernstein's polynomials.
//
// A neighbour may run along a shared edge in the other direction, with u or v counted from the other end. So every sum
// pairs values that change places with each other: the first point with the last, the second with the third, a
// parameter with its complement. Both sides then add the same numbers in the same order.
#include "scene/bezier_patch.h"

#include <cmath>

namespace frontmost {
namespace {

using BernsteinWeights = std::array<double, 4>;
using CubicCurve = std::array<glm::dvec3, 4>;

BernsteinWeights bernstein(PatchParameter t) {
  const double a = t.complement, b = t.value;
  return {a * a * a, 3 * (a * a) * b, 3 * (b * b) * a, b * b * b};
}

// The derivative of the cubic, as weights of its four points.
BernsteinWeights bernstein_slope(PatchParameter t) {
  const double a = t.complement, b = t.value;
  const double first = 3 * (a * a), middle = 6 * (a * b), last = 3 * (b * b);
  return {-first, first - middle, middle - last, last};
}

// Adds the end points to each other first, and the middle points to each other, so that the sum is the same for a curve
// and its reverse.
glm::dvec3 blend(const CubicCurve& p, const BernsteinWeights& w) {
  return (p[0] * w[0] + p[3] * w[3]) + (p[1] * w[1] + p[2] * w[2]);
}

glm::dvec3 blend(const BezierPatch& patch, const BernsteinWeights& u, const BernsteinWeights& v) {
  CubicCurve across;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3* row = &patch.points[4 * i];
    across[i] = blend({row[0], row[1], row[2], row[3]}, v);
  }
  return blend(across, u);
}

PatchPoint evaluate_there(const BezierPatch& patch, PatchParameter u, PatchParameter v) {
  const BernsteinWeights wu = bernstein(u), wv = bernstein(v), du = bernstein_slope(u), dv = bernstein_slope(v);
  PatchPoint point{blend(patch, wu, wv), blend(patch, du, wv), blend(patch, wu, dv), {}};
  // At a pole v has no effect. Near a pole, along_v is d2P / du dv times the distance from the pole in u, so its limit
  // has the direction of d2P / du dv. At a pole at u = 1 that distance is negative.
  glm::dvec3 across = point.along_v;
  if (glm::dot(across, across) < 1e-20 * glm::dot(point.along_u, point.along_u))
    across = blend(patch, du, dv) * (u.value < 0.5 ? 1.0 : -1.0);
  const glm::dvec3 normal = glm::cross(across, point.along_u);
  point.normal = normal / std::sqrt(glm::dot(normal, normal));
  return point;
}

// A parameter slightly nearer to the middle of the patch.
PatchParameter inwards(PatchParameter t) {
  const double value = t.value + (0.5 - t.value) * 0x1p-10;
  return {value, 1 - value};
}

}  // namespace

PatchPoint evaluate(const BezierPatch& patch, PatchParameter u, PatchParameter v) {
  PatchPoint point = evaluate_there(patch, u, v);
  if (is_finite(point.normal)) return point;
  const glm::dvec3 beside = evaluate_there(patch, inwards(u), inwards(v)).normal;
  point.normal = is_finite(beside) ? beside : glm::dvec3(0);
  return point;
}

}  // namespace frontmost
