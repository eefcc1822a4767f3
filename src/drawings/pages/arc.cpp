// SPDX-License-Identifier: Apache-2.0
// From a bulge to its circle, and from consecutive arcs to the one circle on which they lie.
//
// Angles and radii are compared in millimetres of paper, with a tolerance for rounding to thousandths.
#include "pages/arc.h"

#include <cmath>

namespace frontmost::detail {

std::optional<Arc> arc_between(const glm::dvec2& from, const glm::dvec2& to, double bulge) {
  constexpr double flat = 1e-4;  // a tenth of the rounding unit of coordinates
  const glm::dvec2 chord = to - from;
  const double length = glm::length(chord);
  if (std::abs(bulge) * length * 0.5 < flat) return std::nullopt;  // the height of the arc over its chord
  // The centre lies on the chord's bisector; it changes sides where the arc passes a half circle.
  const glm::dvec2 middle = (from + to) * 0.5, across(-chord.y, chord.x);
  Arc arc;
  arc.centre = middle + across * ((1 - bulge * bulge) / (4 * bulge));
  arc.radius = length * (1 + bulge * bulge) / (4 * std::abs(bulge));
  arc.begin = std::atan2(from.y - arc.centre.y, from.x - arc.centre.x);
  arc.turn = 4 * std::atan(bulge);
  return arc;
}

std::optional<Arc> whole_arc(const PageGroup& group, const PagePath& path) {
  constexpr double near = 2e-3;  // millimetres: ends are rounded
  std::optional<Arc> whole;
  for (std::uint32_t i = 0; i < join_count(path); ++i) {
    const Join join = join_of(group, path, i);
    const std::optional<Arc> arc = arc_between(join.from, join.to, join.bulge);
    if (!arc) return std::nullopt;
    if (!whole) {
      whole = arc;
      continue;
    }
    const bool same = glm::distance(arc->centre, whole->centre) < near &&
                      std::abs(arc->radius - whole->radius) < near && (arc->turn > 0) == (whole->turn > 0);
    if (!same) return std::nullopt;
    whole->turn += arc->turn;
  }
  // More than once around is another shape.
  if (whole && std::abs(whole->turn) > 6.2832) return std::nullopt;
  return whole;
}

}  // namespace frontmost::detail
