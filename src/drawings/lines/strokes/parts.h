// SPDX-License-Identifier: Apache-2.0
// The steps from the parts of a drawing to strokes, and their data:
//
//    parts of a drawing --> segments --draw_once--> --chained--> chains --ShortChains--> --uncovered-->
//        --joined_ends--> --straighten--> --find_arcs--> --nearest_first--> Strokes
//
// A chain knows its rank and its points, but not the edges that it came from.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
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

/// Precondition: no arcs.
inline double length_of(const Chain& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.points.size(); ++i) length += glm::distance(chain.points[i - 1], chain.points[i]);
  if (chain.is_closed) length += glm::distance(chain.points.back(), chain.points.front());
  return length;
}

inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Removes overlaps. Where segments lie on each other, within `apart` pixels, the segment of the lowest rank stays, or
/// the first of equal rank. The result is sorted by rank, and keeps the order of segments within each rank.
[[nodiscard]] std::vector<LineSegment> draw_once(const std::vector<LineSegment>& segments, double apart,
                                                 const Execution& execution);

/// Ends that are rounded to the same multiple of 1 / places_per_pixel pixels count as one place.
inline constexpr double places_per_pixel = 1000;

/// Joins segments of one rank wherever exactly two ends meet and, with `through_junctions`, where three to eight meet,
/// those that go on within 15 degrees, the straightest first. Chains are sorted by rank, then by their first segment.
[[nodiscard]] std::vector<Chain> chained(const std::vector<LineSegment>& segments, bool through_junctions);

/// Calls visit(ends, is_closed) for each chain of edges: first the open ones, then those that are closed. The ends of
/// edge i are 2 i and 2 i + 1; each is continued by its partner, or by none (no_index). `ends`: where a walk along the
/// chain enters each of its edges.
template <class Visit>
void for_each_chain(const std::vector<std::uint32_t>& partner, const Visit& visit) {
  std::vector<bool> is_used(partner.size() / 2);
  std::vector<std::uint32_t> ends;
  const auto follow = [&](std::uint32_t end) {
    ends.clear();
    for (; end != no_index && !is_used[end / 2]; end = partner[end ^ 1]) {
      is_used[end / 2] = true;
      ends.push_back(end);
    }
    visit(ends, end != no_index);
  };
  for (std::uint32_t end = 0; end < partner.size(); ++end)
    if (partner[end] == no_index && !is_used[end / 2]) follow(end);
  for (std::uint32_t end = 0; end < partner.size(); end += 2)
    if (!is_used[end / 2]) follow(end);
}

/// The end of the longest run from `first` up to `most` for which fits(end) holds; `first` if the run of `least` steps
/// does not fit. The run is lengthened by doubled steps while it fits, up to `largest_step`, and then by halved steps.
template <class Fits>
[[nodiscard]] std::size_t longest_run(std::size_t first, std::size_t least, std::size_t most, const Fits& fits,
                                      std::size_t largest_step = std::numeric_limits<std::size_t>::max()) {
  std::size_t end = first + least, step = least;
  if (end > most || !fits(end)) return first;
  while (end < most && step < largest_step && fits(std::min(most, end + step))) {
    end = std::min(most, end + step);
    step *= 2;
  }
  for (; step > 0; step /= 2)
    if (end + step <= most && fits(end + step)) end += step;
  return end;
}

/// Removes corners from a chain. Each removed corner lies within `tolerance` of the straight line that replaces it.
void straighten(Chain& chain, double tolerance);

/// Replaces runs of at least four chords by arcs. The ends of these chords lie within `tolerance` of a circle. Each
/// chord stays within `tolerance` of the arc, or has neighbours of similar length.
void find_arcs(Chain& chain, double tolerance);

/// Leaves out chains that lie in the ink of chains that stay: those of a lower rank whose pen is at least as wide, or
/// longer ones of the same rank.
/// `reaches`: how far ink reaches from a chain, by rank. Precondition: no arcs.
[[nodiscard]] std::vector<Chain> uncovered(std::vector<Chain> chains, std::span<const double> reaches,
                                           const Execution& execution);

/// Joins chains of one rank whose ends are at most `apart` pixels from each other, by a straight line; without
/// `any_direction`, only chains that go on within 30 degrees. Chains are sorted by rank, before and after.
/// Precondition: no arcs.
[[nodiscard]] std::vector<Chain> joined_ends(std::vector<Chain> chains, double apart, bool any_direction,
                                             const Execution& execution);

/// The order of drawing, rank by rank, as the ends at which the pen begins: 2 i where chain i begins, 2 i + 1 where it
/// ends. The next end is the one nearest to the pen. Precondition: chains are sorted by rank.
[[nodiscard]] std::vector<std::uint32_t> pen_order(const std::vector<Chain>& chains, const Execution& execution);
/// The chains in the order of pen_order(), each begun at the end given there.
[[nodiscard]] std::vector<Chain> nearest_first(std::vector<Chain> chains, const Execution& execution);

}  // namespace frontmost::lines_detail
