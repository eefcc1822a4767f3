// SPDX-License-Identifier: Apache-2.0
// Four functions are linear along the edge, so their signs at both ends decide. A vertex of the triangle is in the
// planes through it by its number, not by arithmetic. So is a point between two vertices in the planes through both.
//
//    function over the edge       negative at 0, positive at 1: from the root to the end
//    by its two ends              positive at both: all of it       negative or 0 at both: none
//
// The value at a root may be rounded; a sign never is. So an edge that only touches a shadow differs from one that
// enters it.
#include "lines/hiding/occluder.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

Signed times(const Signed& value, int sign) { return {value.value * sign, value.sign * sign}; }

/// Where the triangle is not between the eye and the near plane. With its normal n, a point A of it and the eye E, the
/// line of sight to X meets the triangle's plane at the distance of X times n.(A - E) / n.(X - E).
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

struct OccluderCorners {
  glm::dvec3 at[3];
  const std::uint32_t (&vertices)[3];

  explicit OccluderCorners(const Occluder& o)
      : at{glm::dvec3(o.corners[0]), glm::dvec3(o.corners[1]), glm::dvec3(o.corners[2])}, vertices(o.vertices) {}
  [[nodiscard]] bool has(std::uint32_t vertex, int a, int b) const {
    return vertex == vertices[a] || vertex == vertices[b];
  }
};

/// The part of `hidden` within the planes through the eye. `along(third)` says whether an edge counts that lies within
/// one of these planes from end to end, with the corner `third` opposite.
template <class Along>
Interval in_shadow(const Occluder& occluder, const SightedEdge& edge, const Sight& sight, Interval hidden,
                   const Along& along) {
  const OccluderCorners corners(occluder);
  constexpr int sides[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 3 && hidden.begin < hidden.end; ++k) {
    const int a = sides[k][0], b = sides[k][1];
    const Sight::EyePlane side = sight.plane_through(corners.at[a], corners.at[b]);
    const auto turn = [&](const EndOn& on, const glm::dvec3& place) {
      if (corners.has(on[0], a, b) && corners.has(on[1], a, b)) return Signed{};
      return times(side.turn(place, edge.slack), k < 2 ? occluder.turn : -occluder.turn);
    };
    const Signed from = turn(edge.from_on, edge.from), to = turn(edge.to_on, edge.to);
    if (from.sign == 0 && to.sign == 0 && !along(corners.at[3 - a - b])) return {};
    hidden = overlap(hidden, where_positive(from, to, false));
  }
  if (occluder.is_near && hidden.begin < hidden.end) {
    const FacePlane plane(corners.at[0], corners.at[1], corners.at[2]);
    hidden = overlap(hidden, beyond_near(occluder, edge, sight, plane.normal()));
  }
  return hidden;
}

bool is_own(const Occluder& occluder, const SightedEdge& edge) {
  return occluder.triangle == edge.own[0] || occluder.triangle == edge.own[1];
}

}  // namespace

Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict) {
  if (at_0.sign >= 0 && at_1.sign >= 0) {
    if (is_strict && at_0.sign == 0 && at_1.sign == 0) return {1, 0};
    return {0, 1};
  }
  if (at_0.sign <= 0 && at_1.sign <= 0) return {1, 0};
  // The values may be wrong by rounding; their signs are not.
  const double a = std::abs(at_0.value), b = std::abs(at_1.value);
  const double root = a + b > 0 ? a / (a + b) : 0.5;
  if (at_0.sign < 0) return {root, 1};
  return {0, root};
}

Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight) {
  if (is_own(occluder, edge)) return {};
  const OccluderCorners corners(occluder);
  const FacePlane plane(corners.at[0], corners.at[1], corners.at[2]);
  const auto is_corner = [&](std::uint32_t vertex) {
    return corners.has(vertex, 0, 1) || vertex == occluder.vertices[2];
  };
  const auto depth = [&](const EndOn& on, const glm::dvec3& place) {
    if (is_corner(on[0]) && is_corner(on[1])) return Signed{};
    return times(plane.height(place, edge.slack), -occluder.turn);
  };
  const Interval beyond = where_positive(depth(edge.from_on, edge.from), depth(edge.to_on, edge.to), true);
  return in_shadow(occluder, edge, sight, beyond, [](const glm::dvec3&) { return true; });
}

Interval covered_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight) {
  if (is_own(occluder, edge)) return {};
  return in_shadow(occluder, edge, sight, {0, 1}, [&](const glm::dvec3& third) {
    return sight.plane_through(edge.from, edge.to).turn(third).sign == edge.outer;
  });
}

}  // namespace frontmost::lines_detail
