// SPDX-License-Identifier: Apache-2.0
// Four functions that are linear along the edge, so that their signs at both ends say all. A corner of the triangle is
// in the planes through it by its number, not by arithmetic, and so is a point between two corners in the planes
// through both.
#include "lines/occluder.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

Signed with_sign_of_value(double value) { return {value, value > 0 ? 1 : value < 0 ? -1 : 0}; }

Interval overlap(const Interval& a, const Interval& b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

Signed times(const Signed& value, int sign) { return {value.value * sign, value.sign * sign}; }

/// Where the triangle is not between the eye and the near plane: with its normal n, a point A of it and the eye E, the
/// line of sight to X meets it at the distance of X times n.(A - E) / n.(X - E).
Interval beyond_near(const Occluder& occluder, const SightedEdge& edge, const Sight& sight, const glm::dvec3& n) {
  const glm::dvec3 a(occluder.corners[0]);
  const auto beyond = [&](const glm::dvec3& x, double distance) {
    if (sight.is_parallel())
      return with_sign_of_value(-occluder.turn *
                                ((distance - sight.near()) * glm::dot(n, sight.forward()) - glm::dot(n, x - a)));
    return with_sign_of_value(-occluder.turn *
                              (distance * glm::dot(n, a - sight.eye()) - sight.near() * glm::dot(n, x - sight.eye())));
  };
  return where_positive(beyond(edge.from, edge.from_distance), beyond(edge.to, edge.to_distance), false);
}

}  // namespace

Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict) {
  if (at_0.sign >= 0 && at_1.sign >= 0) {
    if (is_strict && at_0.sign == 0 && at_1.sign == 0) return {1, 0};
    return {0, 1};
  }
  if (at_0.sign <= 0 && at_1.sign <= 0) return {1, 0};
  // The values may be wrong by rounding, their signs are not.
  const double a = std::abs(at_0.value), b = std::abs(at_1.value);
  const double root = a + b > 0 ? a / (a + b) : 0.5;
  if (at_0.sign < 0) return {root, 1};
  return {0, root};
}

Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight) {
  if (occluder.triangle == edge.own[0] || occluder.triangle == edge.own[1]) return {};
  const glm::dvec3 at[3] = {glm::dvec3(occluder.corners[0]), glm::dvec3(occluder.corners[1]),
                            glm::dvec3(occluder.corners[2])};
  const std::uint32_t(&v)[3] = occluder.vertices;
  const FacePlane plane(at[0], at[1], at[2]);
  const auto is_corner = [&](std::uint32_t vertex) { return vertex == v[0] || vertex == v[1] || vertex == v[2]; };
  const auto depth = [&](const EndOn& on, const glm::dvec3& place) {
    if (is_corner(on[0]) && is_corner(on[1])) return Signed{};
    return times(plane.height(place, edge.slack), -occluder.turn);
  };
  Interval hidden = where_positive(depth(edge.from_on, edge.from), depth(edge.to_on, edge.to), true);
  constexpr int sides[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 3 && hidden.begin < hidden.end; ++k) {
    const int a = sides[k][0], b = sides[k][1];
    const Sight::EyePlane side = sight.plane_through(at[a], at[b]);
    const auto is_on_side = [&](std::uint32_t vertex) { return vertex == v[a] || vertex == v[b]; };
    const auto turn = [&](const EndOn& on, const glm::dvec3& place) {
      if (is_on_side(on[0]) && is_on_side(on[1])) return Signed{};
      return times(side.turn(place, edge.slack), k < 2 ? occluder.turn : -occluder.turn);
    };
    hidden = overlap(hidden, where_positive(turn(edge.from_on, edge.from), turn(edge.to_on, edge.to), false));
  }
  if (occluder.is_near && hidden.begin < hidden.end)
    hidden = overlap(hidden, beyond_near(occluder, edge, sight, plane.normal()));
  return hidden;
}

}  // namespace frontmost::lines_detail
