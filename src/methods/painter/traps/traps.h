// SPDX-License-Identifier: Apache-2.0
// Traps: strips along the sides of polygons that reach under polygons that are painted later. A viewer blends the rim
// of every polygon with the pixels below, so the background shows in a pixel that two neighbours share. The printing
// trade's remedy is trapping: the polygon that is painted first is made larger, under its neighbours.
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

/// The end of a strip at a corner of its polygon.
struct TrapEnd {
  double reach = 0;  ///< pixels by which it goes around the corner with the next strip; 0 if it ends before the corner
  glm::dvec2 beyond{0};  ///< direction of the polygon's side beyond the corner, unit length
};

/// A strip along a side of a polygon, counter-clockwise to the eye. Strip and side together are convex.
struct Trap {
  std::uint32_t polygon = 0, side = 0;  ///< the side begins at this corner of this polygon
  std::uint32_t knot_count = 0;
  std::size_t first_knot = 0;  ///< index in TrapList::knots
  glm::dvec2 from{0}, to{0};   ///< the ends of the side, in pixels
  TrapEnd at_from, at_to;
};

/// Marks a side that has no strip.
inline constexpr std::uint32_t no_trap = 0xFFFFFFFF;

/// A corner of an outline, and the strip of the side from it to the next corner. This side is all or a part of the
/// strip's side.
struct TrappedCorner {
  glm::dvec2 at{0};
  std::uint32_t trap = no_trap;  ///< index in TrapList::traps
};

/// The strips of all polygons of a list, by polygon and by side.
struct TrapList {
  std::vector<Trap> traps;
  std::vector<TrapKnot> knots;
  std::vector<std::size_t> ends;  ///< by polygon: end of its traps

  [[nodiscard]] std::span<const Trap> of(std::size_t polygon) const {
    const std::size_t begin = polygon == 0 ? 0 : ends[polygon - 1];
    return {traps.data() + begin, ends[polygon] - begin};
  }
  [[nodiscard]] std::span<const TrapKnot> knots_of(const Trap& trap) const {
    return {knots.data() + trap.first_knot, trap.knot_count};
  }
  /// Sets `corners` to the corners of a polygon with this outline, and to the strips of its sides.
  void set_corners(std::size_t polygon, std::span<const glm::dvec2> outline,
                   std::vector<TrappedCorner>& corners) const {
    corners.clear();
    for (const glm::dvec2& at : outline) corners.push_back({at});
    const std::span<const Trap> own = of(polygon);
    for (const Trap& trap : own) corners[trap.side].trap = std::uint32_t(&trap - traps.data());
  }
  /// Reserves room for the contents of all lists.
  void reserve(const std::vector<TrapList>& lists) {
    reserve_sum(traps, lists, &TrapList::traps);
    reserve_sum(knots, lists, &TrapList::knots);
  }
  /// Adds the strips of a polygon of another list as those of the next polygon of this list.
  void add_polygon(const TrapList& other, std::size_t polygon);
};

/// Returns the outward normal of a side from the side's direction around the polygon; both have unit length.
[[nodiscard]] inline glm::dvec2 outwards(const glm::dvec2& way) { return {-way.y, way.x}; }

/// A corner of a polygon, given by the directions of the sides to it and from it, of unit length.
struct TrapCorner {
  glm::dvec2 to{0}, from{0};

  /// Returns the point at which two strips of this width meet, relative to the corner. It lies on the bisector of the
  /// outer angle. A blunt corner has a mitre. At a sharp corner a mitre would be too long, so both strips end on a line
  /// across.
  [[nodiscard]] glm::dvec2 meeting_point(double width) const;
  [[nodiscard]] bool is_sharp() const { return glm::dot(to, from) < 0; }
};

/// In pixels. Strips of less height are left out.
inline constexpr double least_trap_height = 1.0 / 64;

/// Appends the corners of a closed outline, and of the strips beside its sides. If only a part of a side is there, its
/// strip is cut off beyond that part.
void write_outline(const TrapList& list, std::span<const TrappedCorner> outline, std::vector<glm::dvec2>& corners);

/// Returns the traps of polygons that are in the order of painting. A trap reaches under later polygons by at most
/// `width` pixels, beside sides and around corners, as far as later polygons or polygons of the same group hide it. So
/// the polygon that is painted first in a pixel covers all of it. Traps end a pixel below open places, or at two fifths
/// of the way to them if that is less, so that outlines hardly grow bold. Cost as for visible_parts().
[[nodiscard]] TrapList make_traps(std::span<const ScreenPolygon> polygons, const View& view, double width,
                                  const Execution& execution);

}  // namespace frontmost::painter_detail
