// SPDX-License-Identifier: Apache-2.0
// What closed lines go around.
#pragma once

#include <vector>

#include "lines/sections/outlines.h"

namespace frontmost::lines_detail {

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

}  // namespace frontmost::lines_detail
