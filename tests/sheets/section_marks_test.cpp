// SPDX-License-Identifier: Apache-2.0
// Cutting lines and section names have the parts that ISO 128-3 requires, at their places.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/sheets.h"
#include "sheets/planned_view.h"

namespace frontmost::test {
namespace {

using namespace detail;

SectionMarks one_line(const CuttingLine& line) { return draw_section_marks(std::span(&line, 1), {}); }

TEST(SectionMarks, ALineHasThickEndsArrowsAndLettersOnTheViewersSide) {
  // The line is upright and its section looks to the right: the arrows are on the left.
  const SectionMarks marks = one_line({{50, 20}, {50, 80}, {1, 0}, "A"});
  ASSERT_EQ(marks.layer.groups.size(), 4u);
  const PageGroup &thin = marks.layer.groups[0], &thick = marks.layer.groups[1], &arrows = marks.layer.groups[2];
  EXPECT_EQ(thin.points, (std::vector<glm::dvec2>{{50, 17}, {50, 83}}));
  EXPECT_EQ(thin.pen.dashes.size(), 4u);
  EXPECT_EQ(thick.points, (std::vector<glm::dvec2>{{50, 17}, {50, 11}, {50, 83}, {50, 89}}));
  EXPECT_EQ(thick.pen.width, 2 * thin.pen.width);
  EXPECT_TRUE(thick.pen.dashes.empty());
  ASSERT_EQ(arrows.paths.size(), 4u);
  for (const std::uint32_t shaft : {0u, 2u}) {
    const glm::dvec2 from = arrows.points[arrows.paths[shaft].first], to = arrows.points[arrows.paths[shaft].first + 1];
    EXPECT_EQ(to.x, 50);
    EXPECT_LT(from.x, to.x);
    EXPECT_EQ(from.y, to.y);
  }
  ASSERT_EQ(marks.boxes.size(), 2u);
  for (const PageBox& box : marks.boxes) {
    EXPECT_GE(box.low.x, 50 - section_arrow_room);
    EXPECT_LE(box.high.x, 50);
  }
  EXPECT_GE(marks.boxes[0].low.y, 20 - cutting_line_room);
  EXPECT_LE(marks.boxes[1].high.y, 80 + cutting_line_room);
  for (const glm::dvec2& p : marks.layer.groups[3].points) EXPECT_LT(p.x, 45);
}

TEST(SectionMarks, NamesStandInTheirMiddle) {
  const ViewName name{{100, 40}, "B-B"};
  const SectionMarks marks = draw_section_marks({}, std::span(&name, 1));
  ASSERT_EQ(marks.layer.groups.size(), 1u);
  EXPECT_EQ(marks.layer.name, "9 sections");
  double low = 1e9, high = -1e9;
  for (const glm::dvec2& p : marks.layer.groups[0].points) {
    low = std::min(low, p.x);
    high = std::max(high, p.x);
    EXPECT_LE(p.y, 40);
    EXPECT_GE(p.y, 35);
  }
  EXPECT_NEAR((low + high) / 2, 100, 0.5);
  EXPECT_NEAR(high - low, text_width("B-B", 5), 2);
  EXPECT_TRUE(draw_section_marks({}, {}).layer.groups.empty());
  EXPECT_THROW((void)one_line({{1, 1}, {1, 1}, {1, 0}, "A"}), Error);
  EXPECT_THROW((void)one_line({{1, 1}, {std::nan(""), 1}, {1, 0}, "A"}), Error);
  EXPECT_THROW((void)draw_section_marks({}, {}, {.text_height = 0}), Error);
}

}  // namespace
}  // namespace frontmost::test
