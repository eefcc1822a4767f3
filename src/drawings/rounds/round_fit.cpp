// SPDX-License-Identifier: Apache-2.0
// A circle is fitted by I. Kasa's method: x^2 + y^2 = 2 a x + 2 b y + c is linear in a, b and c, so least squares about
// the points' mean give two equations for two unknowns. The method is biased on short arcs of noisy points, but
// vertices of meshes lie on their circles to six digits or more.
#include "rounds/round_fit.h"

namespace frontmost::lines_detail {

Across::Across(const glm::dvec3& axis) {
  const glm::dvec3 size = glm::abs(axis);
  const glm::dvec3 least = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  u = glm::normalize(glm::cross(axis, least));
  v = glm::cross(axis, u);
}

std::optional<Tube> tube_through(std::span<const glm::dvec3> points, const glm::dvec3& axis) {
  const Across across(axis);
  glm::dvec3 middle(0);
  for (const glm::dvec3& p : points) middle += p;
  middle /= double(points.size());
  // x^2 + y^2 = 2 a x + 2 b y + c, about the middle: sums of x and y are 0.
  double xx = 0, xy = 0, yy = 0, xs = 0, ys = 0, squares = 0;
  for (const glm::dvec3& p : points) {
    const double x = glm::dot(p - middle, across.u), y = glm::dot(p - middle, across.v), s = x * x + y * y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xs += x * s;
    ys += y * s;
    squares += s;
  }
  const double determinant = 2 * (xx * yy - xy * xy);
  if (!(determinant > 1e-14 * squares * squares)) return std::nullopt;
  const double a = (xs * yy - ys * xy) / determinant, b = (ys * xx - xs * xy) / determinant;
  const double radius = std::sqrt(squares / double(points.size()) + a * a + b * b);
  if (!std::isfinite(radius)) return std::nullopt;
  return Tube{middle + a * across.u + b * across.v, axis, radius};
}

glm::dvec3 common_perpendicular(std::span<const glm::dvec3> vectors) {
  glm::dmat3 sum(0);
  for (const glm::dvec3& n : vectors) sum += glm::outerProduct(n, n);
  // The adjugate's powers converge to the eigenvector of the least eigenvalue; taking the longest column is one more
  // step.
  const auto adjugate = [](const glm::dmat3& m) {
    return glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  };
  glm::dmat3 power = adjugate(sum);
  for (int i = 0; i < 4; ++i) {
    const double trace = power[0][0] + power[1][1] + power[2][2];
    if (!(trace > 0)) return glm::dvec3(0, 0, 1);
    power /= trace;
    power = power * power;
  }
  glm::dvec3 longest = power[0];
  for (const int i : {1, 2})
    if (glm::dot(power[i], power[i]) > glm::dot(longest, longest)) longest = power[i];
  const double length = glm::length(longest);
  return length > 0 ? longest / length : glm::dvec3(0, 0, 1);
}

}  // namespace frontmost::lines_detail
