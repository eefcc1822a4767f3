// SPDX-License-Identifier: Apache-2.0
// Circular arcs from the bulges of pages.
//
//              . - .
//          .-'   |   '-.         1 at a half circle: the height of the arc over half of its chord
//        from ---+--- to         0 on a straight line
//
// The bulge of a join is the tangent of a quarter of the angle through which its arc turns. Formats want other numbers:
// a radius and flags, a centre and angles, or curves that come near.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// Angles in radians from +x towards +y; `turn` is negative where it runs the other way.
struct Arc {
  glm::dvec2 centre{0};
  double radius = 0, begin = 0, turn = 0;
};

/// The arc from `from` to `to`; none where it is straight: without bulge, without length, or so flat that it stays
/// within a ten-thousandth of a millimetre of its chord.
[[nodiscard]] std::optional<Arc> arc_between(const glm::dvec2& from, const glm::dvec2& to, double bulge);

/// The join that begins at point `i` of a path: its end, and its bulge.
struct Join {
  glm::dvec2 from, to;
  double bulge;
};
[[nodiscard]] inline Join join_of(const PageGroup& group, const PagePath& path, std::uint32_t i) {
  const std::uint32_t at = path.first + i, next = i + 1 < path.count ? at + 1 : path.first;
  return {group.points[at], group.points[next], group.bulges.empty() ? 0 : group.bulges[at]};
}
[[nodiscard]] inline std::uint32_t join_count(const PagePath& path) {
  return path.is_closed ? path.count : path.count - 1;
}

/// The one circle that all of a path runs along, in one direction; none otherwise.
[[nodiscard]] std::optional<Arc> whole_arc(const PageGroup& group, const PagePath& path);

}  // namespace frontmost::detail
