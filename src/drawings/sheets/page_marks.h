// SPDX-License-Identifier: Apache-2.0
// Marks on a page besides the lines of a model: numbers, arrowheads, and the boxes that they cover.
//
// Marks are pen strokes like the lines of the model, so plotters and DXF have them, too. An arrowhead is two slender
// triangles whose outlines fill them.
#pragma once

#include <string>

#include "base/decimal.h"
#include "frontmost/sheets.h"

namespace frontmost::detail {

/// A rectangle of the page, in millimetres.
struct PageBox {
  glm::dvec2 low{0}, high{0};
};

/// An arrowhead, three pen widths wide and `length` millimetres long. It consists of two slender triangles side by
/// side, whose sides are so near each other that the pen fills them. So it is the same in every format and on a
/// plotter.
inline void add_arrowhead(PageGroup& group, const glm::dvec2& tip, const glm::dvec2& pointing, double length) {
  const double width = group.pen.width;
  const glm::dvec2 base = tip - length * pointing, across(-pointing.y * width, pointing.x * width);
  const glm::dvec2 corners[] = {tip, base - 1.5 * across, base - 0.5 * across,
                                tip, base + 0.5 * across, base + 1.5 * across};
  group.add(corners, true);
}

/// A number with at most so many significant digits, without trailing zeros: "0.25", "1e+07".
[[nodiscard]] inline std::string number_text(double value, int digits = 6) { return general_text(value, digits); }

/// Two sides: "210 x 297".
[[nodiscard]] inline std::string size_text(const glm::dvec2& size, int digits = 6) {
  return number_text(size.x, digits) + " x " + number_text(size.y, digits);
}

/// Two sides in millimetres to a tenth: "12.0 x 7.5".
[[nodiscard]] inline std::string tenths_text(const glm::dvec2& size) {
  return fixed_text(size.x, 1) + " x " + fixed_text(size.y, 1);
}

}  // namespace frontmost::detail
