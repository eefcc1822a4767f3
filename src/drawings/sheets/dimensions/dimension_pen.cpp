// SPDX-License-Identifier: Apache-2.0
// Lines and numbers are in two groups, because their pens have different widths. Everything drawn becomes an obstacle,
// so no number is put on a line that a dimension has drawn before.
#include "sheets/dimensions/dimension_pen.h"

#include <numbers>

#include "sheets/page_marks.h"

namespace frontmost::detail {

DimensionPen::DimensionPen(const DimensionOptions& options, Obstacles& obstacles)
    : options_(options), obstacles_(obstacles), lines_{"", options.pen}, texts_{"", text_pen(options.text_height)} {
  texts_.pen.color = options.pen.color;
}

void DimensionPen::line(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 ends[] = {from, to};
  lines_.add(ends, false);
  obstacles_.add(PageSegment{from, to});
}

void DimensionPen::arrow(const glm::dvec2& tip, const glm::dvec2& pointing) {
  add_arrowhead(lines_, tip, pointing, arrow_length());
}

void DimensionPen::text(std::string_view text, const glm::dvec2& at, TextAlign align, bool is_upright) {
  const glm::dvec2 above = is_upright ? glm::dvec2(-text_distance, 0) : glm::dvec2(0, -text_distance);
  add_text(texts_, text, at + above,
           {options_.text_height, is_upright ? std::numbers::pi / 2 : 0, align, TextLine::bottom});
  if (!is_upright) return obstacles_.add(box_of(text, at, align));
  const PageBox level = box_of(text, {0, 0}, align);
  // A quarter turn maps (x, y) to (y, -x).
  obstacles_.add(PageBox{at + glm::dvec2(level.low.y, -level.high.x), at + glm::dvec2(level.high.y, -level.low.x)});
}

PageBox DimensionPen::box_of(std::string_view text, const glm::dvec2& at, TextAlign align) const {
  const double width = width_of(text);
  const double left = align == TextAlign::left ? 0 : align == TextAlign::right ? -width : -width / 2;
  return {at + glm::dvec2(left - text_distance, -options_.text_height - 2 * text_distance),
          at + glm::dvec2(left + width + text_distance, -text_distance / 2)};
}

std::vector<PageGroup> DimensionPen::take() {
  std::vector<PageGroup> groups;
  for (PageGroup* const group : {&lines_, &texts_})
    if (!group->paths.empty()) groups.push_back(std::move(*group));
  return groups;
}

}  // namespace frontmost::detail
