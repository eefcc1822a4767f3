// SPDX-License-Identifier: Apache-2.0
// Traps: strips along the sides of polygons, which reach under what is painted later.
//
// A viewer blends the rim of every polygon with what is below it, so the background shows in a pixel that two
// neighbours share. The remedy of the print trade is trapping: what is painted first is made larger, under its
// neighbours.
//
//                       knot 1 ________ knot 2
//      around `from`         /          \            A knot lies `along` pixels from the beginning of the side, and
//              .____________/            \           `height` pixels outside of it. Here the strip goes around the
//              |          knot 0          \ knot 3   first corner together with the strip of the side before, and
//     . . . . .+---------------------------+         ends beside the other corner.
//             from         side            to
#pragma once

#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

struct TrapKnot {
  double along, height;  ///< pixels
};

/// How a strip ends at a corner of its polygon.
struct TrapEnd {
  double reach = 0;  ///< pixels by which it goes around the corner with the strip beyond; 0: it ends before the corner
  glm::dvec2 beyond{0};  ///< the way of the polygon's side beyond the corner, of unit length
};

/// A strip along a side of a polygon, counter-clockwise as it is seen. It is convex together with its side.
struct Trap {
  std::uint32_t polygon = 0, side = 0;  ///< the side begins at this corner of this polygon
  std::uint32_t knot_count = 0;
  std::size_t first_knot = 0;  ///< of TrapList::knots
  glm::dvec2 from{0}, to{0};   ///< the ends of the side, in pixels
  TrapEnd at_from, at_to;
};

/// Of a side that has no strip.
inline constexpr std::uint32_t no_trap = 0xFFFFFFFF;

/// A corner of an outline, and the side from it to the next: all or a part of a polygon's side that has this strip.
struct TrappedCorner {
  glm::dvec2 at{0};
  std::uint32_t trap = no_trap;  ///< of TrapList::traps
};

/// The strips of all polygons of a list, by polygon and by side.
struct TrapList {
  std::vector<Trap> traps;
  std::vector<TrapKnot> knots;
  std::vector<std::size_t> ends;  ///< by polygon: of its traps

  [[nodiscard]] std::span<const Trap> of(std::size_t polygon) const {
    const std::size_t begin = polygon == 0 ? 0 : ends[polygon - 1];
    return {traps.data() + begin, ends[polygon] - begin};
  }
  [[nodiscard]] std::span<const TrapKnot> knots_of(const Trap& trap) const {
    return {knots.data() + trap.first_knot, trap.knot_count};
  }
  /// Sets `corners` to those of a polygon, which has this outline.
  void set_corners(std::size_t polygon, std::span<const glm::dvec2> outline, std::vector<TrappedCorner>& corners) const;
  /// Room for all of some lists.
  void reserve(const std::vector<TrapList>& lists);
  /// Adds the strips of a polygon of another list as those of the next polygon of this one.
  void add_polygon(const TrapList& other, std::size_t polygon);
};

/// Outwards from a way of unit length around a polygon.
[[nodiscard]] inline glm::dvec2 outwards(const glm::dvec2& way) { return {-way.y, way.x}; }

/// A corner of a polygon, by the ways to it and from it, of unit length.
struct TrapCorner {
  glm::dvec2 to{0}, from{0};

  /// Where two strips of a width meet, seen from the corner: on the line that halves the angle outside. A blunt corner
  /// has a mitre. At a sharp one that would be too far away, so both strips end on a line across.
  [[nodiscard]] glm::dvec2 meeting_point(double width) const;
  [[nodiscard]] bool is_sharp() const { return glm::dot(to, from) < 0; }
};

/// Pixels: strips that are lower are not there.
inline constexpr double least_trap_height = 1.0 / 64;

/// Appends the corners of a closed outline, and those of the strips beside its sides. Of a strip whose side is there in
/// part, what lies beside the rest of the side is cut off.
void write_outline(const TrapList& list, std::span<const TrappedCorner> outline, std::vector<glm::dvec2>& corners);

/// The traps of polygons in the order of painting. A polygon reaches under what is painted later and lies beside it, by
/// `width` pixels or less, as far as that, or other polygons of its group, hide the trap, and around its corners
/// likewise. So what is painted first in a pixel covers all of it. Traps end a pixel below what is open, or at two
/// fifths of the way to it where that is less, so that outlines hardly grow bold. Cost as for visible_parts().
[[nodiscard]] TrapList make_traps(std::span<const ScreenPolygon> polygons, const View& view, double width,
                                  const Execution& execution);

}  // namespace frontmost::painter_detail
