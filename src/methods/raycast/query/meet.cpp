// SPDX-License-Identifier: Apache-2.0
// The hit of a ray or segment, decided exactly on the floats of the query and of the vertices.
//
// Signs of determinants are computed in doubles first, with a bound; undecided signs are computed without rounding. So
// rounding never changes which triangle is met. Only the place along the ray is rounded, and is kept between the
// triangle's vertices along every axis: rounding leaves no better bound for slivers.

#include <algorithm>
#include <cmath>

#include "base/exact_vector.h"
#include "raycast/query/query_rule.h"

namespace frontmost::raycast_detail {
namespace {

/// The sums as numbers that are never rounded.
ExactVector unrounded(const HighLowVector& v) {
  ExactVector sums;
  for (std::size_t axis = 0; axis < 3; ++axis) sums[axis] = Expansion(v.low[axis]) + Expansion(v.high[axis]);
  return sums;
}

glm::dvec3 rounded(const HighLowVector& v) { return {v.high[0], v.high[1], v.high[2]}; }

/// The place at which the ray meets the plane of vertices `c`, which are relative to the origin. The place is kept
/// between the vertices along every axis: with slivers, or triangles tiny against their distance, rounding leaves no
/// better bound. The signs are certain, so the rounded place must not contradict them.
double place_along(const Query& q, const glm::dvec3& along, const std::array<glm::dvec3, 3>& c) {
  double nearest = std::numeric_limits<double>::denorm_min();
  double farthest = q.is_segment ? 1.0 : std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) continue;
    const double low = std::min({c[0][axis], c[1][axis], c[2][axis]}) / along[axis];
    const double high = std::max({c[0][axis], c[1][axis], c[2][axis]}) / along[axis];
    nearest = std::max(nearest, std::min(low, high));
    farthest = std::min(farthest, std::max(low, high));
  }
  const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double t = glm::dot(n, c[0]) / glm::dot(n, along);
  // NaN comes from underflow. The range may be empty by a rounding.
  return std::max(std::min(std::isnan(t) ? nearest : std::max(t, nearest), farthest),
                  std::numeric_limits<double>::denorm_min());
}

}  // namespace

HighLowVector high_low(const glm::vec3& v) { return {{v.x, v.y, v.z}, {}}; }

HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a) {
  HighLowVector d;
  for (int i = 0; i < 3; ++i) {
    const double to = b[i], from = a[i], difference = to - from, from_to = difference - to;
    d.high[std::size_t(i)] = difference;
    d.low[std::size_t(i)] = (to - (difference - from_to)) - (from + from_to);
  }
  return d;
}

int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c) {
  const std::array<double, 3>&x = a.high, &y = b.high, &z = c.high;
  double det = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t j = std::size_t(i + 1) % 3, k = std::size_t(i + 2) % 3;
    const double p = y[j] * z[k], q = y[k] * z[j];
    det += x[std::size_t(i)] * (p - q);
    size += std::abs(x[std::size_t(i)]) * (std::abs(p) + std::abs(q));
  }
  // Three roundings of the coordinates and five more: less than 16 half units in the last place of the size.
  if (std::abs(det) > size * 0x1p-49) return det > 0 ? 1 : -1;
  return dot(unrounded(a), cross(unrounded(b), unrounded(c))).sign();
}

bool is_valid(const Query& q) {
  if (!is_finite(q.origin)) return false;
  if (q.is_segment) return is_finite(q.end) && q.end != q.origin;
  return is_finite(q.direction) && q.direction != glm::vec3(0);
}

RayHit meet(const Query& q, const std::array<glm::vec3, 3>& corners, PrimitiveId id) {
  const HighLowVector along = q.is_segment ? high_low_difference(q.end, q.origin) : high_low(q.direction);
  std::array<HighLowVector, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = high_low_difference(corners[k], q.origin);
  // How the line turns about each edge. Seen against the direction, counter-clockwise is negative: front.
  const int u = determinant_sign(along, c[1], c[2]), v = determinant_sign(along, c[2], c[0]),
            w = determinant_sign(along, c[0], c[1]);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  const int facing = least >= 0 ? most : most <= 0 ? least : 0;
  if (facing == 0) return {};
  // The origin's side of the plane decides. A surface through the origin is not met.
  if (determinant_sign(c[0], c[1], c[2]) != facing) return {};
  if (q.is_segment) {
    std::array<HighLowVector, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = high_low_difference(corners[k], q.end);
    if (determinant_sign(e[0], e[1], e[2]) != -facing) return {};
  }
  return {id, place_along(q, rounded(along), {rounded(c[0]), rounded(c[1]), rounded(c[2])}), facing < 0};
}

}  // namespace frontmost::raycast_detail
