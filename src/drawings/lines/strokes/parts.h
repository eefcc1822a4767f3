// SPDX-License-Identifier: Apache-2.0
// The steps from the parts of a drawing to strokes, and their data:
//
//    parts of a drawing --> segments --draw_once--> --chained--> chains --without_short_ones-->
//        --straighten--> --find_arcs--> --nearest_first--> Strokes
//
// Each step takes only the result of the step before: a chain stores its rank and its points, but not the edges from
// which it was made.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

/// A straight piece on the screen. Pieces of different rank are never joined; lower ranks are drawn over higher ones.
struct LineSegment {
  glm::dvec2 from, to;
  std::uint32_t rank;
  bool is_contour = false;  ///< a piece of a silhouette or a boundary
};

/// Joined segments. A closed one does not repeat its first point.
struct Chain {
  std::vector<glm::dvec2> points;
  std::vector<double> bulges;  ///< empty, or one for each point
  std::uint32_t rank = 0;
  bool is_closed = false;
  bool is_contour = false;  ///< some of its segments are pieces of a contour
};

inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Removes overlaps. Where segments lie on each other, within `apart` pixels, the segment of the lowest rank stays, or
/// the first of equal rank. The result is sorted by rank, and keeps the order of segments within each rank.
[[nodiscard]] std::vector<LineSegment> draw_once(const std::vector<LineSegment>& segments, double apart,
                                                 const Execution& execution);

/// Ends that are rounded to the same multiple of 1 / places_per_pixel pixels count as one place.
inline constexpr double places_per_pixel = 1000;

/// Joins segments of one rank wherever exactly two ends meet. Chains are sorted by rank, then by their first segment.
[[nodiscard]] std::vector<Chain> chained(const std::vector<LineSegment>& segments);

/// Removes corners from a chain. Each removed corner lies within `tolerance` of the straight line that replaces it.
void straighten(Chain& chain, double tolerance);

/// Replaces runs of at least four chords by arcs. The ends of these chords lie within `tolerance` of a circle. Each
/// chord stays within `tolerance` of the arc, or has neighbours of similar length.
void find_arcs(Chain& chain, double tolerance);

/// Sorts the chains of each rank in drawing order. The next chain begins at the end that is nearest to the end of the
/// chain before, and is joined to that chain if their distance is at most `touching`.
[[nodiscard]] std::vector<Chain> nearest_first(std::vector<Chain> chains, double touching, const Execution& execution);

}  // namespace frontmost::lines_detail
