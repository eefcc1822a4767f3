// SPDX-License-Identifier: Apache-2.0
// What strokes are made of, on their way:
//
//    parts of a drawing --> segments --draw_once--> --chained--> chains --without_crumbs-->
//        --straighten--> --find_arcs--> --nearest_first--> Strokes
//
// Each step takes what the one before gave, and none looks back: a chain knows its rank and its points, and nothing of
// the edges that it came from.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

/// A straight piece on the screen; what differs in rank is never joined. Lower ranks are drawn over higher ones.
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
  bool is_contour = false;  ///< a part of it is
};

inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Of what lies on each other, within `apart` pixels, what has the lower rank, or comes first. What is left keeps its
/// order.
[[nodiscard]] std::vector<LineSegment> draw_once(const std::vector<LineSegment>& segments, double apart,
                                                 const Execution& execution);

/// Ends within about 1 / places_per_pixel are one place.
inline constexpr double places_per_pixel = 1000;

/// Joins segments of one rank wherever exactly two ends meet. By rank, then in the order of the segments.
[[nodiscard]] std::vector<Chain> chained(const std::vector<LineSegment>& segments);

struct CrumbRule {
  double shortest;  ///< pixels: of a line that is no crumb
  double touching;  ///< pixels: what is nearer counts as touching
  std::function<bool(std::uint32_t rank)> is_hidden;
};

/// Chains without those that are shorter than the rule has it, but for pieces of outlines: a crumb of which an end
/// touches nothing is left out, and so is one between lines that go on without it, unless it is a contour. What holds
/// others together is joined to one of them that has its rank, or stays. What is hidden holds nothing that is seen.
/// Near-linear. Precondition: no arcs.
[[nodiscard]] std::vector<Chain> without_crumbs(std::vector<Chain> chains, const CrumbRule& rule,
                                                const Execution& execution);

/// Leaves out corners that lie within `tolerance` of the line between those that stay.
void straighten(Chain& chain, double tolerance);

/// Puts arcs where four chords or more have their ends on a circle, within `tolerance`, and stay within it of the arc
/// or are evenly stepped.
void find_arcs(Chain& chain, double tolerance);

/// Chains of one rank, each begun at the end that is nearest to the last one's end, and joined with it where the two
/// are within `touching`.
[[nodiscard]] std::vector<Chain> nearest_first(std::vector<Chain> chains, double touching, const Execution& execution);

}  // namespace frontmost::lines_detail
