// SPDX-License-Identifier: Apache-2.0
// Arrowheads as strokes of a pen.
#pragma once

#include "frontmost/page.h"

namespace frontmost::detail {

/// Three pens wide, and `length` millimetres long.
/// Filled by strokes of the pen, so that it is the same in every format and on a plotter: two slender triangles side by
/// side, whose sides are so near each other that the pen fills them.
inline void add_arrowhead(PageGroup& group, const glm::dvec2& tip, const glm::dvec2& pointing, double length) {
  const double width = group.pen.width;
  const glm::dvec2 base = tip - length * pointing, across(-pointing.y * width, pointing.x * width);
  const glm::dvec2 corners[] = {tip, base - 1.5 * across, base - 0.5 * across,
                                tip, base + 0.5 * across, base + 1.5 * across};
  group.add(corners, true);
}

}  // namespace frontmost::detail
