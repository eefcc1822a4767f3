// SPDX-License-Identifier: Apache-2.0
// What a triangle hides of an edge: what lies in its shadow, as if the eye were a lamp.
//
//            ____        The shadow is bounded by the triangle's own plane and by three planes through the eye, one
//   eye  .--|    |.....  along each side. Each of them is a function that is linear along the edge, so that its signs
//        '--|____|.....  at both ends, and its root between them, say where the edge is inside. What is inside all
//                        four, from the last entry to the first exit, is hidden.
#pragma once

#include <algorithm>
#include <array>

#include "frontmost/base.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A triangle as a thing that hides. One cache line.
struct alignas(64) Occluder {
  glm::vec3 corners[3];       ///< world space, in the order of `vertices`
  std::uint32_t vertices[3];  ///< ascending, so that neighbours ask their common plane with the same bits
  std::int32_t turn;          ///< of the corners as they are seen: 1 left, -1 right
  std::uint32_t triangle;
  bool is_near;  ///< some of it may lie before the near plane
};

/// An end of a segment: a vertex, twice, or a point of the edge between two.
using EndOn = std::array<std::uint32_t, 2>;

/// A segment that things are held against, from t = 0 to 1.
struct SightedEdge {
  glm::dvec3 from{0}, to{0};  ///< world space
  EndOn from_on{}, to_on{};
  std::array<std::uint32_t, 2> own{no_index, no_index};  ///< triangles that it lies within
  /// How far the rounding of ends that are no vertices may have moved them, by axis; 0: both are vertices.
  double slack = 0;
  int outer = 0;  ///< the side, as Sight's turns, on which none of the edge's own triangles are seen; 0: neither
  double from_distance = 0, to_distance = 0;  ///< planar
};

/// SightedEdge::slack of a segment whose ends were constructed: some roundings of their size.
[[nodiscard]] inline double slack_of(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 size = glm::max(glm::abs(from), glm::abs(to));
  return 8.0 / 9007199254740992.0 * std::max({size.x, size.y, size.z, 1e-100});
}

/// Empty unless begin < end.
struct Interval {
  double begin = 1, end = 0;
};

/// What both hold; empty where it ends before it begins.
inline Interval overlap(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a function that is linear from 0 to 1, with these ends, is not negative; `is_strict`: where it is positive.
[[nodiscard]] Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict);

/// Where `occluder` hides the edge: within its three planes through the eye (the shadow is closed), and beyond its own
/// plane (within it, nothing is hidden). An end that is no vertex counts as within every plane that its rounding leaves
/// open.
[[nodiscard]] Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

/// Where `occluder` is seen just beside the edge, on its outer side, before it or behind. An edge of the occluder that
/// is seen exactly along this one has it there if the occluder lies on that side.
[[nodiscard]] Interval covered_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

}  // namespace frontmost::lines_detail
