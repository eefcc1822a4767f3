// SPDX-License-Identifier: Apache-2.0
// Frames and title blocks: ISO 5457's sizes on every paper, and fields with the given texts.
#include <set>

#include "io/drawings/sample_page.h"
#include "sheets/paper.h"
#include "support/lettering_shapes.h"

namespace frontmost::test {
namespace {

using namespace detail;

struct SheetZones {
  glm::dvec2 size;
  int columns, rows;  // number of zones, from the standard's table
};
constexpr SheetZones sheets[] = {
    {{841, 1189}, 16, 24}, {{1189, 841}, 24, 16}, {{594, 841}, 12, 16}, {{841, 594}, 16, 12}, {{420, 594}, 8, 12},
    {{594, 420}, 12, 8},   {{297, 420}, 6, 8},    {{420, 297}, 8, 6},   {{210, 297}, 4, 6},   {{297, 210}, 6, 4}};

const TitleBlock full{"Angle bracket",
                      "AB-17",
                      "Erika Mustermann",
                      "2026-03-01",
                      "Works",
                      "1:2",
                      "mm",
                      "A3",
                      ProjectionMethod::first_angle,
                      2,
                      5};

PageGroup group_of(const PageLayer& layer, const std::string& name) {
  for (const PageGroup& group : layer.groups)
    if (group.name == name) return group;
  throw std::runtime_error("no group " + name);
}

bool says(const PageLayer& layer, const std::string& text, double height) {
  for (const PageGroup& group : layer.groups)
    if (std::abs(group.pen.width - height / 10) < 1e-9 && holds_text(group.points, text, height)) return true;
  return false;
}

TEST(Frame, LeavesTwentyMillimetresForFilingAndTenElsewhere) {
  for (const SheetZones& sheet : sheets) {
    const DrawingSpace space = drawing_space(sheet.size);
    EXPECT_EQ(space.low, glm::dvec2(20, 10));
    EXPECT_EQ(space.high, sheet.size - 10.0);
    EXPECT_EQ(space.block, space.high - glm::dvec2(180, 36));
    const PageGroup frame = group_of(draw_frame(sheet.size, full), "frame");
    EXPECT_EQ(frame.pen.width, 0.7);
    EXPECT_EQ(frame.points[0], space.low);
    EXPECT_EQ(frame.points[2], space.high);
  }
  for (const glm::dvec2 small : {glm::dvec2(209, 297), glm::dvec2(297, 99), glm::dvec2(std::nan(""), 297)})
    EXPECT_THROW((void)draw_frame(small, full), Error);
}

TEST(Frame, ZonesAreFiftyMillimetresFromTheMiddleAndNamed) {
  for (const SheetZones& sheet : sheets) {
    const PageLayer layer = draw_frame(sheet.size, full);
    const DrawingSpace space = drawing_space(sheet.size);
    const PageGroup zones = group_of(layer, "zones");
    std::set<double> ends[2];
    for (const PagePath& path : zones.paths) {
      if (path.count != 2) continue;
      const glm::dvec2 from = zones.points[path.first], to = zones.points[path.first + 1];
      EXPECT_NEAR(glm::distance(from, to), 5, 1e-9);
      ends[from.x == to.x ? 0 : 1].insert(from.x == to.x ? from.x : from.y);
    }
    for (const int axis : {0, 1}) {
      // All lines that separate zones, except the middle one, plus the frame's two corners.
      EXPECT_EQ(int(ends[axis].size()), (axis == 0 ? sheet.columns : sheet.rows)) << sheet.size.x << ' ' << axis;
      for (const double at : ends[axis])
        EXPECT_TRUE(at == space.low[axis] || at == space.high[axis] ||
                    std::abs(std::remainder(at - sheet.size[axis] / 2, 50)) < 1e-9);
    }
    const PageGroup names = group_of(layer, "zones: text");
    EXPECT_TRUE(holds_text(names.points, std::to_string(sheet.columns), 3.5));
    EXPECT_FALSE(holds_text(names.points, std::to_string(sheet.columns + 1), 3.5) && sheet.columns > 9);
    const std::string last(1, std::string("ABCDEFGHJKLMNPQRSTUVWXYZ")[std::size_t(sheet.rows - 1)]);
    EXPECT_TRUE(holds_text(names.points, last, 3.5)) << last;
    EXPECT_EQ(names.pen.width, 0.35);
  }
}

TEST(Frame, CentringMarksStandInTheMiddleAndOutOfTheTitleBlock) {
  for (const SheetZones& sheet : sheets) {
    const PageGroup frame = group_of(draw_frame(sheet.size, full), "frame");
    const DrawingSpace space = drawing_space(sheet.size);
    int marks = 0;
    for (const PagePath& path : frame.paths) {
      if (path.count != 2) continue;
      ++marks;
      const glm::dvec2 from = frame.points[path.first], to = frame.points[path.first + 1];
      EXPECT_TRUE(from.x == to.x ? from.x == sheet.size.x / 2 : from.y == sheet.size.y / 2);
      EXPECT_FALSE(glm::all(glm::greaterThan(to, space.block)) && glm::all(glm::lessThan(to, space.high)));
    }
    EXPECT_EQ(marks, 4);
  }
}

TEST(Frame, EverythingLiesOnThePage) {
  for (const SheetZones& sheet : sheets) {
    Page page{sheet.size.x, sheet.size.y, "", {draw_frame(sheet.size, full)}};
    EXPECT_EQ(page.layers[0].name, "8 frame");
    EXPECT_NO_THROW(validate(page));
    for (const PageGroup& group : page.layers[0].groups)
      for (const glm::dvec2& p : group.points) {
        EXPECT_GE(p.x, group.pen.width / 2 - 1e-9) << group.name;
        EXPECT_GE(p.y, group.pen.width / 2 - 1e-9) << group.name;
        EXPECT_LE(p.x, sheet.size.x - group.pen.width / 2 + 1e-9) << group.name;
        EXPECT_LE(p.y, sheet.size.y - group.pen.width / 2 + 1e-9) << group.name;
      }
  }
}

TEST(TitleBlockDrawing, SaysWhatItIsTold) {
  const PageLayer layer = draw_frame({420, 297}, full);
  EXPECT_TRUE(says(layer, "Angle bracket", 5));
  EXPECT_TRUE(says(layer, "AB-17", 5));
  EXPECT_TRUE(says(layer, "Works", 3.5));
  for (const char* const text : {"Erika Mustermann", "2026-03-01", "1:2", "mm", "A3", "2/5", "Technical drawing"})
    EXPECT_TRUE(says(layer, text, 2.5)) << text;
  for (const char* const label : {"Legal owner", "Created by", "Approved by", "Title", "Number", "Date of issue",
                                  "Sheet", "Document type", "Scale", "Unit", "Projection"})
    EXPECT_TRUE(says(layer, label, 1.8)) << label;
}

TEST(TitleBlockDrawing, TextStaysInItsField) {
  TitleBlock block = full;
  block.title = "A long title of some ninety characters, which is more than two lines take at 3.5 mm, is smaller";
  block.number = std::string(60, 'W');
  block.owner = std::string(200, 'M');
  const PageLayer layer = draw_frame({420, 297}, block);
  const glm::dvec2 corner = drawing_space({420, 297}).block;
  const auto ends_of = [&](double left, double top, double right, double bottom) {
    std::size_t found = 0;
    for (const PageGroup& group : layer.groups)
      if (group.name == "title block: text")
        for (const glm::dvec2& p : group.points) {
          const glm::dvec2 q = p - corner;
          // No point lies on the field's borders.
          for (const double x : {left, right}) EXPECT_FALSE(std::abs(q.x - x) < 0.3 && q.y > top && q.y < bottom);
          found += q.x > left && q.x < right && q.y > top && q.y < bottom;
        }
    return found;
  };
  EXPECT_GT(ends_of(69, 18, 129, 36), 100u);
  EXPECT_EQ(ends_of(129, 9, 180, 27), 60u * 5);
  EXPECT_EQ(ends_of(0, 0, 69, 18), 200u * 5);
  block.title = "Two words parted";
  EXPECT_TRUE(says(draw_frame({420, 297}, block), "Two words", 5));
}

TEST(TitleBlockDrawing, TheConeStandsWhereItsProjectionPutsIt) {
  for (const bool is_first : {true, false}) {
    TitleBlock block = full;
    block.projection = is_first ? ProjectionMethod::first_angle : ProjectionMethod::third_angle;
    const PageGroup symbol = group_of(draw_frame({420, 297}, block), "title block: projection");
    ASSERT_EQ(symbol.paths.size(), 3u);
    const glm::dvec2 *const cone = symbol.points.data(), *const ring = cone + symbol.paths[1].first;
    EXPECT_EQ(cone[0].x < ring->x, is_first);
    EXPECT_LT(cone[3].y - cone[0].y, cone[2].y - cone[1].y);  // its narrow end is on the left: both rings are visible
    EXPECT_LT(cone[0].x, cone[1].x);
    EXPECT_EQ(symbol.bulges[symbol.paths[2].first], 1);
  }
  TitleBlock block = full;
  block.projection = ProjectionMethod::none;
  EXPECT_THROW((void)group_of(draw_frame({420, 297}, block), "title block: projection"), std::runtime_error);
}

}  // namespace
}  // namespace frontmost::test
