// SPDX-License-Identifier: Apache-2.0
// Lettering: position and size of texts, and every letter within its width.
#include <map>
#include <numbers>

#include "frontmost/sheets.h"
#include "io/drawings/sample_page.h"
#include "pages/formats.h"

namespace frontmost::test {
namespace {

/// Bounds of paths; arcs are represented by points on them.
struct Extent {
  glm::dvec2 low{1e9}, high{-1e9};
  void include(const glm::dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

Extent extent_of(const PageGroup& group) {
  Extent extent;
  for (const PagePath& path : group.paths) {
    extent.include(group.points[path.first]);
    for (std::uint32_t i = 0; i < detail::join_count(path); ++i) {
      const detail::Join join = detail::join_of(group, path, i);
      extent.include(join.to);
      if (const auto arc = detail::arc_between(join.from, join.to, join.bulge))
        for (double t = 0; t <= 1; t += 1.0 / 64) {
          const double angle = arc->begin + t * arc->turn;
          extent.include(arc->centre + arc->radius * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
    }
  }
  return extent;
}

PageGroup lettered(std::string_view text, const glm::dvec2& at = {0, 0}, const TextStyle& style = {}) {
  PageGroup group{"", text_pen(style.height)};
  add_text(group, text, at, style);
  return group;
}

std::string utf8(char32_t code) {
  if (code < 0x80) return std::string(1, char(code));
  return {char(0xC0 | code >> 6), char(0x80 | (code & 0x3F))};
}

TEST(Lettering, CapitalsReachFromTheirPlaceToTheirHeight) {
  const PageGroup group = lettered("H", {20, 30}, {10});
  EXPECT_EQ(group.pen.width, 1);
  const Extent extent = extent_of(group);  // for the centre line of a pen of 1 mm
  EXPECT_NEAR(extent.low.x, 20.5, 1e-12);
  EXPECT_NEAR(extent.high.y, 29.5, 1e-12);
  EXPECT_NEAR(extent.low.y, 20.5, 1e-12);
  EXPECT_NEAR(extent.high.x + 0.5 - 20, text_width("H", 10), 1e-12);
  EXPECT_NEAR(extent_of(lettered("x", {0, 0}, {10})).low.y, -6.5, 1e-12);
  EXPECT_NEAR(extent_of(lettered("p", {0, 0}, {10})).high.y, 2.5, 1e-12);
  EXPECT_NEAR(extent_of(lettered("O", {0, 0}, {10})).low.y, -9.5, 1e-12);  // the lowest point is on an arc
}

TEST(Lettering, WidthsAddUpWithTwoWidthsOfThePenBetween) {
  const double pen = 0.35;
  EXPECT_NEAR(text_width("HE"), text_width("H") + text_width("E") + 2 * pen, 1e-12);
  EXPECT_NEAR(text_width("H E") - text_width("H") - text_width("E"), 6 * pen, 1e-12);
  EXPECT_NEAR(text_width("Dvo\xC5\x99\xC3\xA1k", 7), 2 * text_width("Dvo\xC5\x99\xC3\xA1k"), 1e-12);
  EXPECT_EQ(text_width(""), 0);
  EXPECT_TRUE(lettered("").paths.empty());
  EXPECT_TRUE(lettered(" ").paths.empty());
}

TEST(Lettering, StandsAboutItsPlaceAsAsked) {
  const Extent left = extent_of(lettered("Ex"));
  const double width = text_width("Ex");
  for (const auto& [align, by] :
       {std::pair(TextAlign::left, 0.0), std::pair(TextAlign::centre, 0.5), std::pair(TextAlign::right, 1.0)})
    EXPECT_NEAR(extent_of(lettered("Ex", {0, 0}, {3.5, 0, align})).low.x, left.low.x - by * width, 1e-12);
  for (const auto& [line, by] :
       {std::pair(TextLine::bottom, 0.0), std::pair(TextLine::middle, 0.5), std::pair(TextLine::top, 1.0)})
    EXPECT_NEAR(extent_of(lettered("Ex", {0, 0}, {3.5, 0, TextAlign::left, line})).low.y, left.low.y + by * 3.5, 1e-12);
}

TEST(Lettering, TurnsCounterClockwiseForWhoReads) {
  const PageGroup level = lettered("R9"), up = lettered("R9", {50, 60}, {3.5, std::numbers::pi / 2});
  ASSERT_EQ(level.points.size(), up.points.size());
  EXPECT_EQ(level.bulges, up.bulges);
  for (std::size_t i = 0; i < up.points.size(); ++i)  // text to the right becomes text upwards
    EXPECT_LT(glm::distance(up.points[i], glm::dvec2(50 + level.points[i].y, 60 - level.points[i].x)), 1e-12);
}

TEST(Lettering, EveryLetterOfLatin1IsThereAndNoOtherOne) {
  std::map<std::string, char32_t> shapes;
  const auto shape_of = [](const std::string& text) {
    std::string shape;
    const PageGroup group = lettered(text, {0, 0}, {10});
    for (const PagePath& path : group.paths) {
      shape += "M";
      for (std::uint32_t i = path.first; i < path.first + path.count; ++i)
        for (const double value : {group.points[i].x, group.points[i].y, group.bulges[i]})
          shape += std::to_string(value) + " ";
    }
    return shape;
  };
  const std::string box = shape_of("\xE6\xBC\xA2");
  EXPECT_EQ(lettered("\xE6\xBC\xA2").paths.size(), 1u);
  for (char32_t code = 0x21; code <= 0xFF; ++code) {
    if ((code >= 0x7F && code <= 0xA0) || code == 0xAD) continue;  // control characters, and hyphens checked above
    const std::string shape = shape_of(utf8(code));
    EXPECT_NE(shape, box) << unsigned(code);
    EXPECT_FALSE(shape.empty()) << unsigned(code);
    const auto [known, is_new] = shapes.try_emplace(shape, code);
    EXPECT_TRUE(is_new) << unsigned(code) << " looks like " << unsigned(known->second);
  }
  for (const char* const sign : {"\xE2\x8C\x80", "\xE2\x86\xA7"})
    EXPECT_NE(shape_of(sign), box) << "diameter and depth";
  // Characters without a shape become a box each, and are never left out.
  for (const char* const odd : {"\n", "\x1b", "\x7f", "\xff", "\xc3"}) EXPECT_EQ(shape_of(odd), box) << odd;
  EXPECT_EQ(lettered(std::string(3, '\0')).paths.size(), 3u);
}

TEST(Lettering, NoLetterLeavesItsWidthOrItsLine) {
  const auto check = [](const std::string& text) {
    const PageGroup group = lettered(text, {0, 0}, {10});
    if (group.paths.empty()) return;
    const Extent extent = extent_of(group);
    EXPECT_GE(extent.low.x, 0.5 - 0.01) << text;
    EXPECT_LE(extent.high.x, text_width(text, 10) - 0.5 + 0.01) << text;
    EXPECT_GE(extent.low.y, -12.5 - 0.5) << text;
    EXPECT_LE(extent.high.y, 3 - 0.5) << text;
    EXPECT_TRUE(group.bulges.size() == group.points.size());
  };
  for (char32_t code = 1; code < 0x800; ++code) check(utf8(code));  // includes the accents of Central Europe
  for (const char* const text :
       {"\xE2\x8C\x80", "\xE2\x86\xA7", "\xE2\x82\xAC", "\xE2\x89\xA4", "\xE2\x80\x9E", "\xE2\x80\xA6"})
    check(text);
}

TEST(Lettering, IsOfLinesAndArcsInEveryFormat) {
  Page page{100, 50, "", {{"8 frame", {lettered("O", {10, 40}, {10})}}}};
  EXPECT_EQ(saved(page, PageFormat::svg).find("M16 33.25a2.75 2.75 0 0 0-5.5 0l0 3.5"),
            saved(page, PageFormat::svg).find("M"))
      << saved(page, PageFormat::svg);
  EXPECT_NE(operators_of(saved(page, PageFormat::pdf)).find(" c\n"), std::string::npos);
  EXPECT_NE(saved(page, PageFormat::dxf).find("42\n1\n"), std::string::npos);
  // The text follows lines that have no arcs yet.
  PageGroup mixed{"", {}};
  mixed.add(std::vector<glm::dvec2>{{1, 1}, {2, 3}}, false);
  add_text(mixed, "S", {5, 5});
  page.layers[0].groups = {mixed};
  EXPECT_NO_THROW(validate(page));
}

}  // namespace
}  // namespace frontmost::test
