// SPDX-License-Identifier: Apache-2.0
// The part of an edge that a triangle hides: the part in the triangle's shadow, as if the eye were a lamp.
//
//            ____        The shadow is bounded by the triangle's own plane and by three planes through the eye, one
//   eye  .--|    |.....  along each side. Each plane is a linear function along the edge. Its signs at both ends, and
//        '--|____|.....  its root between them, say where the edge is inside. The hidden part is inside all four,
//                        from the last entry to the first exit.
#pragma once

#include <algorithm>
#include <array>

#include "frontmost/base.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A triangle that may hide edges. One cache line.
struct alignas(64) Occluder {
  glm::vec3 corners[3];       ///< world space, in the order of `vertices`
  std::uint32_t vertices[3];  ///< ascending, so that neighbours compute their common plane with the same bits
  std::int32_t turn;          ///< orientation of the corners as they are seen: 1 left, -1 right
  std::uint32_t triangle;
  bool is_near;  ///< a part of it may lie before the near plane
};

/// An end of a segment: a vertex, twice, or the two vertices of the edge on which the end lies.
using EndOn = std::array<std::uint32_t, 2>;

/// A segment that is compared with occluders, from t = 0 to 1.
struct SightedEdge {
  glm::dvec3 from{0}, to{0};  ///< world space
  EndOn from_on{}, to_on{};
  std::array<std::uint32_t, 2> own{no_index, no_index};  ///< triangles that contain the segment
  /// Bound on the rounding error of constructed ends, for each axis; 0: both ends are vertices.
  double slack = 0;
  int outer = 0;  ///< the side, as for Sight's turns, on which none of the edge's own triangles are seen; 0: neither
                  ///< side
  double from_distance = 0, to_distance = 0;  ///< planar
};

/// SightedEdge::slack of a segment whose ends were constructed: some rounding errors of their size.
[[nodiscard]] inline double slack_of(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 size = glm::max(glm::abs(from), glm::abs(to));
  return 8.0 / 9007199254740992.0 * std::max({size.x, size.y, size.z, 1e-100});
}

/// Empty unless begin < end.
struct Interval {
  double begin = 1, end = 0;
};

/// The intersection of both; empty where it ends before it begins.
inline Interval overlap(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a linear function from 0 to 1 with these values at its ends is not negative; `is_strict`: where it is
/// positive.
[[nodiscard]] Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict);

/// Where `occluder` hides the edge: within its three planes through the eye (boundary included), and beyond its own
/// plane (boundary excluded). A constructed end counts as within every plane for which rounding leaves its side open.
[[nodiscard]] Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

/// Where `occluder` is seen just beside the edge on its outer side, before or behind the edge. An edge of the occluder
/// that is seen exactly along this one counts if the occluder lies on that side.
[[nodiscard]] Interval covered_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

}  // namespace frontmost::lines_detail
