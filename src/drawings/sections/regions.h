// SPDX-License-Identifier: Apache-2.0
// From segments in a plane to closed lines, to the regions that these bound, and to triangles that fill the regions.
//
//    segments --find_outlines--> closed lines --regions_of--> outer lines with their holes --fill--> triangles
//
// Coordinates are never recomputed, so a filled face shares its vertices with the walls beside it to the bit.
#pragma once

#include <array>
#include <vector>

#include "frontmost/lines.h"

namespace frontmost::lines_detail {

/// Orders points of a plane from left to right, and upwards for equal x.
[[nodiscard]] inline bool is_left_of(const glm::vec2& a, const glm::vec2& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// The axes of a cutting plane: two within the plane and one across it. The first two and CuttingPlane::towards are
/// right-handed, in this order. The plane is perpendicular to a world axis, so coordinates are selected and never
/// computed.
struct PlaneAxes {
  explicit PlaneAxes(const CuttingPlane& plane)
      : across(int(plane.towards) % 3), is_minus(int(plane.towards) >= 3), at(float(plane.at)) {}

  /// Whether a point lies behind the plane.
  [[nodiscard]] bool is_behind(const glm::vec3& p) const { return is_minus ? p[across] > at : p[across] < at; }
  [[nodiscard]] glm::vec2 in_plane(const glm::vec3& p) const { return {p[axis(0)], p[axis(1)]}; }
  [[nodiscard]] glm::vec3 in_space(const glm::vec2& p) const {
    glm::vec3 place;
    place[across] = at;
    place[axis(0)] = p.x;
    place[axis(1)] = p.y;
    return place;
  }
  [[nodiscard]] int axis(int i) const { return (across + (is_minus ? 2 - i : 1 + i)) % 3; }

  int across;
  bool is_minus;
  float at;
};

/// The segment in which the plane cuts a triangle. If the triangle is wound outwards, the removed part is on the
/// segment's left.
struct CutSegment {
  glm::vec2 from, to;
};

/// A closed line: the last point is joined to the first. No point occurs twice.
using SectionOutline = std::vector<glm::vec2>;

struct Outlines {
  std::vector<SectionOutline> closed;
  std::size_t open_count = 0;
  bool is_wound_alike = true;  ///< no segment had to be reversed
};

/// Joins segments to closed lines. Where lines touch, the leftmost continuation is taken, so that lines do not cross.
/// Segments in opposite directions cancel out. O(n log n).
[[nodiscard]] Outlines find_outlines(const std::vector<CutSegment>& segments, const Execution& execution);

/// A connected part of the plane.
struct Region {
  SectionOutline outer;               ///< counter-clockwise
  std::vector<SectionOutline> holes;  ///< clockwise
  double area = 0;
};

/// The regions that lines enclose, by the nonzero rule if all lines are wound alike, else by the even-odd rule. Lines
/// may touch but must not cross. A line bounds nothing if its area is 0 up to rounding, or if both of its sides are
/// filled, or neither is. O(points), times the number of lines around each point.
[[nodiscard]] std::vector<Region> regions_of(Outlines outlines, const Execution& execution);

using FlatTriangle = std::array<glm::vec2, 3>;

/// Appends counter-clockwise triangles that fill the region. Each side of a triangle is also a side of another triangle
/// or of an outline. Corners on one line may give triangles without area. All signs are exact. Outlines that cross
/// themselves are filled by triangles that may overlap and run clockwise. O(n log n) for usual parts, at worst O(n^2).
void fill(const Region& region, std::vector<FlatTriangle>& triangles, const Execution& execution);

}  // namespace frontmost::lines_detail
