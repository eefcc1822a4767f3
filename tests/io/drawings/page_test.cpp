// SPDX-License-Identifier: Apache-2.0
// Valid and invalid pages; files are complete, equal every time, or absent.
#include <limits>

#include "frontmost/files.h"
#include "io/drawings/sample_page.h"

namespace frontmost::test {
namespace {

constexpr PageFormat all_formats[] = {PageFormat::svg, PageFormat::pdf, PageFormat::dxf, PageFormat::json};
constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

void expect_refused(const Page& page, const std::string& reason) {
  try {
    validate(page);
    ADD_FAILURE() << reason;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(PageChecks, SizesAndPlaces) {
  for (const double side : {0.0, -1.0, 1e6, nan, infinity}) {
    Page page = sample_page();
    page.height = side;
    expect_refused(page, "page: its sides");
  }
  for (const double place : {1e7, nan, -infinity}) {
    Page page = sample_page();
    page.layers[1].groups[0].points[2].y = place;
    expect_refused(page, "layer 1: group 0: a point");
  }
  for (const double bulge : {11.0, nan}) {
    Page page = sample_page();
    page.layers[1].groups[1].bulges[0] = bulge;
    expect_refused(page, "layer 1: group 1: a bulge");
  }
}

TEST(PageChecks, PensAndLists) {
  const auto changed = [](auto&& change) {
    Page page = sample_page();
    change(page.layers[0].groups[0]);
    return page;
  };
  expect_refused(changed([](PageGroup& g) { g.pen.width = -1; }), "width");
  expect_refused(changed([](PageGroup& g) { g.pen.width = 1000.1; }), "width");
  EXPECT_NO_THROW(validate(changed([](PageGroup& g) { g.pen.width = 1000; })));
  expect_refused(changed([](PageGroup& g) { g.pen.width = nan; }), "width");
  expect_refused(changed([](PageGroup& g) { g.pen.dashes = {1}; }), "pairs");
  expect_refused(changed([](PageGroup& g) { g.pen.dashes = {1, 0}; }), "dashes and gaps");
  expect_refused(changed([](PageGroup& g) { g.fills = {{}, {}}; }), "fills and paths");
  expect_refused(changed([](PageGroup& g) { g.paths[0].is_part = true; }), "there is none before it");
  expect_refused(changed([](PageGroup& g) { g.bulges = {0}; }), "bulges and points");
  expect_refused(changed([](PageGroup& g) { g.paths[0].count = 4; }), "beyond the last one of the page");
  expect_refused(changed([](PageGroup& g) { g.paths[0].count = 0; }), "no points");
  expect_refused(changed([](PageGroup& g) { g.paths[0] = {3, 1, false}; }), "beyond the last one of the page");
  expect_refused(changed([](PageGroup& g) {
                   g.paths[0] = {2, 0xFFFFFFFFu, false};
                 }),
                 "beyond the last one of the page");
}

TEST(PageFiles, AreTheSameEveryTimeAndForAnyNumberOfThreads) {
  for (const PageFormat format : all_formats) {
    const std::string one = saved(sample_page(), format, {.threads = 1});
    EXPECT_GT(one.size(), 300u);
    EXPECT_EQ(saved(sample_page(), format, {.threads = 7}), one);
  }
}

TEST(PageFiles, AnEmptyPageIsAFileToo) {
  for (const PageFormat format : all_formats) {
    EXPECT_FALSE(saved({}, format).empty());
    Page page;
    page.layers = {{"1 empty", {{"nothing", {}}}}};
    EXPECT_FALSE(saved(page, format).empty());
  }
}

TEST(PageFiles, AreNotThereWhenSomethingFails) {
  const ScratchFolder folder;
  Page page = sample_page();
  EXPECT_THROW(save(page, folder.file("page.png")), Error);
  page.layers[0].groups[0].fills = {{}};
  EXPECT_THROW(save(page, folder.file("page.dxf")), Error);
  page.width = nan;
  EXPECT_THROW(save(page, folder.file("page.svg")), Error);
  Watch watch;
  watch.cancelled = [] { return true; };
  EXPECT_THROW(save(sample_page(), folder.file("page.svg"), std::nullopt, {.watch = &watch}), Error);
  EXPECT_EQ(folder.entry_count(), 0u);
  save(sample_page(), folder.file("page.SVG"));
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(PageFiles, SuffixesNameFormats) {
  EXPECT_EQ(page_format("a/b.svg"), PageFormat::svg);
  EXPECT_EQ(page_format("b.PDF"), PageFormat::pdf);
  EXPECT_EQ(page_format("b.c.dxf"), PageFormat::dxf);
  EXPECT_EQ(page_format("b.json"), PageFormat::json);
  EXPECT_EQ(page_format("svg"), std::nullopt);
  EXPECT_EQ(page_format("-"), std::nullopt);
}

TEST(PageFiles, ExtremePlacesAreWrittenRight) {
  Page page{1e5, 1e5, "", {}};
  PageGroup group{"", {}};
  group.add(std::vector<glm::dvec2>{{-1e6, 1e6}, {1e6, -1e6}, {-0.0004, 0.0006}}, false);
  page.layers = {{"", {group}}};
  EXPECT_NE(saved(page, PageFormat::svg).find("M-1000000 1000000l2000000-2000000-1000000 1000000.001"),
            std::string::npos);
  EXPECT_NE(saved(page, PageFormat::json).find("[[-1000000, 1000000], [1000000, -1000000], [0, 0.001]]"),
            std::string::npos);
}

TEST(Page, FiguresAreFilledPathsOnTheirBackground) {
  Figure figure;
  figure.view.width = 96;
  figure.view.height = 48;
  figure.title = "two";
  figure.background = glm::vec3(1);
  figure.corners = {{0, 0}, {96, 0}, {0, 48}, {96, 48}, {96, 0}, {0, 48}};
  figure.rings = {{0, 3}, {3, 3}};
  figure.shapes = {{glm::u8vec4(255, 0, 0, 255), 1, 0, 0}, {glm::u8vec4(0, 0, 255, 255), 1, 1, 1}};
  const Page page = page_of(figure);
  EXPECT_NEAR(page.width, 25.4, 1e-12);
  EXPECT_NEAR(page.height, 12.7, 1e-12);
  EXPECT_EQ(page.title, "two");
  ASSERT_EQ(page.layers.size(), 1u);
  ASSERT_EQ(page.layers[0].groups.size(), 2u) << "the background, and both shapes";
  EXPECT_EQ(page.layers[0].groups[1].paths.size(), 2u);
  EXPECT_EQ(page.layers[0].groups[1].fills[1], (PageColor{0, 0, 255, 255}));
  const ScratchFolder folder;
  save(figure, folder.file("figure.svg"));
  save(page, folder.file("page.svg"));
  EXPECT_EQ(load_text(folder.file("figure.svg"), 1 << 20), load_text(folder.file("page.svg"), 1 << 20));
  EXPECT_THROW(save(figure, folder.file("figure.png")), Error);
}

}  // namespace
}  // namespace frontmost::test
