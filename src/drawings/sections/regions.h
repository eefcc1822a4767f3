// SPDX-License-Identifier: Apache-2.0
// What a plane leaves of triangles: their segments in it put together to closed lines, the regions that these go
// around, and triangles that fill the regions.
//
//    segments --find_outlines--> closed lines --regions_of--> outer lines with their holes --fill--> triangles
//
// Coordinates are those of the plane, as floats; the same corners come back, so a face that is filled has the corners
// of the walls beside it to the bit.
#pragma once

#include <array>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

/// With what is cut on its left, where its triangle is wound outwards.
struct CutSegment {
  glm::vec2 from, to;
};

/// The last point is joined to the first. No point is there twice.
using SectionOutline = std::vector<glm::vec2>;

struct Outlines {
  std::vector<SectionOutline> closed;
  std::size_t open_count = 0;
  bool is_wound_alike = true;  ///< no segment had to be turned round
};

/// Where lines touch, those to the left are taken first, so that they do not cross. Segments that are there in both
/// directions cancel each other. O(n log n).
[[nodiscard]] Outlines find_outlines(const std::vector<CutSegment>& segments, const Execution& execution);

/// A part of the plane in one piece.
struct Region {
  SectionOutline outer;               ///< counter-clockwise
  std::vector<SectionOutline> holes;  ///< clockwise
  double area = 0;
};

/// By the nonzero rule where lines are wound alike, else by the even-odd rule. Lines must not cross; those that touch
/// may. Lines whose area is nothing but rounding, and those with the same on both sides, bound nothing.
/// O(points), times the lines that lie around each.
[[nodiscard]] std::vector<Region> regions_of(Outlines outlines, const Execution& execution);

using FlatTriangle = std::array<glm::vec2, 3>;

/// Appends triangles that fill the region, counter-clockwise, each side with the corners of another or of an outline;
/// where corners lie on one line also some without area. All signs are exact. What crosses itself is filled by
/// triangles that may overlap and run clockwise, so that the sides of outlines have a triangle there, too. O(n log n)
/// for what looks like a part, at worst O(n^2).
void fill(const Region& region, std::vector<FlatTriangle>& triangles, const Execution& execution);

}  // namespace frontmost::lines_detail
