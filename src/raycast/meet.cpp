// SPDX-License-Identifier: Apache-2.0
// What a ray or segment meets: decided exactly on the floats of the query and of the corners.

#include <algorithm>
#include <cmath>

#include "raycast/query_kernel.h"

namespace frontmost::raycast_detail {
namespace {

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

glm::dvec3 rounded(const ExactVector& v) { return {v.high[0], v.high[1], v.high[2]}; }

}  // namespace

bool is_valid(const Query& q) {
  if (!is_finite(q.origin)) return false;
  if (q.is_segment) return is_finite(q.end) && q.end != q.origin;
  return is_finite(q.direction) && q.direction != glm::vec3(0);
}

RayHit meet(const Query& q, const std::array<glm::vec3, 3>& corners, PrimitiveId id) {
  const ExactVector along = q.is_segment ? exact_difference(q.end, q.origin) : exact(q.direction);
  std::array<ExactVector, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = exact_difference(corners[k], q.origin);
  // Which way the line turns about each edge. Seen against the direction, counter-clockwise is negative: front.
  const int u = determinant_sign(along, c[1], c[2]), v = determinant_sign(along, c[2], c[0]),
            w = determinant_sign(along, c[0], c[1]);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  const int facing = least >= 0 ? most : most <= 0 ? least : 0;
  if (facing == 0) return {};
  // The origin's side of the plane; a surface through it is not met.
  if (determinant_sign(c[0], c[1], c[2]) != facing) return {};
  if (q.is_segment) {
    std::array<ExactVector, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = exact_difference(corners[k], q.end);
    if (determinant_sign(e[0], e[1], e[2]) != -facing) return {};
  }
  const glm::dvec3 a = rounded(c[0]), n = glm::cross(rounded(c[1]) - a, rounded(c[2]) - a);
  const double t = glm::dot(n, a) / glm::dot(n, rounded(along));
  // The signs are certain, so rounding cannot be allowed to say otherwise; NaN is what underflow leaves.
  const double least_t = std::numeric_limits<double>::denorm_min();
  const double most_t = q.is_segment ? 1.0 : std::numeric_limits<double>::max();
  return {id, std::min(std::max(std::isnan(t) ? 0.0 : t, least_t), most_t), facing < 0};
}

}  // namespace frontmost::raycast_detail
