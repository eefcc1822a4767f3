// SPDX-License-Identifier: Apache-2.0
// With weights w and vertices c of its own triangle, the point is (sum of w c) / (sum of w) + lift: no float, but a
// fraction. A vertex q of another triangle lies at (sum of w (q - c - lift)) / (sum of w) from the point. Leaving out
// the division does not change signs of determinants, and sums of products remain.
//
//    w0 (q - c0 - lift) + w1 (q - c1 - lift) + w2 (q - c2 - lift)     a vertex q seen from the point, times their sum
//
// Signs are computed in doubles first, with a bound, and if that leaves them open, as sums of products without
// rounding. So rounding never darkens a point of a triangle that lies in the plane of its neighbour.
#include <algorithm>
#include <cmath>

#include "base/exact_vector.h"
#include "raycast/query/query_rule.h"

namespace frontmost::raycast_detail {
namespace {

float dot3(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Coordinates with an error bound: at most 16 half units in the last place of `size`.
struct Rounded {
  glm::dvec3 value{0}, size{0};
};

Rounded rounded_from(const TrianglePoint& point, const glm::vec3& corner) {
  Rounded result;
  const glm::dvec3 lift(point.lift);
  for (int i = 0; i < 3; ++i) {
    const double weight = point.weights[i];
    const glm::dvec3 side = glm::dvec3(corner) - glm::dvec3(point.corners[std::size_t(i)]);
    result.value += weight * (side - lift);
    result.size += weight * (glm::abs(side) + glm::abs(lift));
  }
  return result;
}

ExactVector exact_from(const TrianglePoint& point, const glm::vec3& corner) {
  ExactVector result;
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      Expansion side = Expansion::difference(corner[axis], point.corners[std::size_t(i)][axis]);
      side = side - Expansion(point.lift[axis]);
      result[std::size_t(axis)] = result[std::size_t(axis)] + Expansion(point.weights[i]) * side;
    }
  return result;
}

/// The sign, or 2 if rounding leaves it open.
int likely_sign(const Rounded& a, const Rounded& b, const Rounded& c) {
  const double det = glm::dot(a.value, glm::cross(b.value, c.value));
  const glm::dvec3 &p = b.size, &q = c.size;
  const glm::dvec3 minors(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
  // Three coordinates of 16 half units each, and five more roundings.
  if (std::abs(det) > glm::dot(a.size, minors) * (64 * 0x1p-53)) return det > 0 ? 1 : -1;
  return 2;
}

/// The vertices of a triangle, relative to the point, and the direction of the light.
class LitTriangle {
 public:
  LitTriangle(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light)
      : corners_(corners), point_(point), light_(to_light) {
    for (std::size_t k = 0; k < 3; ++k) rounded_[k] = rounded_from(point, corners[k]);
    rounded_light_ = {glm::dvec3(to_light), glm::abs(glm::dvec3(to_light))};
  }

  /// How the light's ray turns about the edge from vertex i to vertex j.
  [[nodiscard]] int turn(std::size_t i, std::size_t j) const {
    const int likely = likely_sign(rounded_light_, rounded_[i], rounded_[j]);
    if (likely != 2) return likely;
    return dot(exact(light_), cross(exact_corner(i), exact_corner(j))).sign();
  }

  /// The point's side of the plane; 0 on the plane.
  [[nodiscard]] int side() const {
    const int likely = likely_sign(rounded_[0], rounded_[1], rounded_[2]);
    if (likely != 2) return likely;
    return dot(exact_corner(0), cross(exact_corner(1), exact_corner(2))).sign();
  }

 private:
  [[nodiscard]] ExactVector exact_corner(std::size_t k) const { return exact_from(point_, corners_[k]); }

  const CornerPositions& corners_;
  const TrianglePoint& point_;
  const glm::vec3& light_;
  std::array<Rounded, 3> rounded_;
  Rounded rounded_light_;
};

}  // namespace

bool is_valid(const TrianglePoint& point) {
  // Zero, or NaN if a value is not finite.
  float nothing = dot3(point.lift, glm::vec3(0)) + dot3(point.weights, glm::vec3(0));
  for (const glm::vec3& corner : point.corners) nothing += dot3(corner, glm::vec3(0));
  const glm::vec3& w = point.weights;
  return nothing == 0 && w.x >= 0 && w.y >= 0 && w.z >= 0 && (w.x > 0 || w.y > 0 || w.z > 0);
}

bool is_own(const CornerPositions& corners, const TrianglePoint& point) {
  // Compares positions, not ids: a triangle that is in a file twice would darken itself.
  return std::is_permutation(corners.begin(), corners.end(), point.corners.begin());
}

bool stands_before(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light) {
  if (is_own(corners, point)) return false;
  const LitTriangle sight(corners, point, to_light);
  // The rule of meet(): all turns go to one side, edges included, and the plane lies ahead.
  const int u = sight.turn(1, 2), v = sight.turn(2, 0), w = sight.turn(0, 1);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  const int facing = least >= 0 ? most : most <= 0 ? least : 0;
  return facing != 0 && sight.side() == facing;
}

glm::dvec3 position_of(const TrianglePoint& point) {
  glm::dvec3 sum(0);
  for (int i = 0; i < 3; ++i) sum += double(point.weights[i]) * glm::dvec3(point.corners[std::size_t(i)]);
  return sum / (double(point.weights.x) + double(point.weights.y) + double(point.weights.z)) + glm::dvec3(point.lift);
}

glm::dvec3 passed_point(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light) {
  const glm::dvec3 a(corners[0]), light(to_light), from = position_of(point);
  const glm::dvec3 normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return from + glm::dot(normal, a - from) / glm::dot(normal, light) * light;
}

}  // namespace frontmost::raycast_detail
