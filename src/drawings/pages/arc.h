// SPDX-License-Identifier: Apache-2.0
// Circular arcs from the bulges of pages.
//
//              . - .
//          .-'   |   '-.         the bulge is the height of the arc by half of its chord:
//        from ---+--- to         1 for a half circle, 0 for a straight line
//
// The bulge of a join is the tangent of a quarter of the angle through which its arc turns. Formats need other numbers:
// a radius and flags, a centre and angles, or approximating curves.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// Angles in radians from +x towards +y; `turn` is negative in the opposite direction.
struct Arc {
  glm::dvec2 centre{0};
  double radius = 0, begin = 0, turn = 0;
};

/// The arc from `from` to `to`. None for a straight join: without bulge, without length, or within a ten-thousandth of
/// a millimetre of its chord.
[[nodiscard]] std::optional<Arc> arc_between(const glm::dvec2& from, const glm::dvec2& to, double bulge);

/// The join that begins at point `i` of a path: its ends, and its bulge.
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

/// The circle on which a whole path lies, in one direction; none otherwise.
[[nodiscard]] std::optional<Arc> whole_arc(const PageGroup& group, const PagePath& path);

}  // namespace frontmost::detail
