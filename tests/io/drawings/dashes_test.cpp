// SPDX-License-Identifier: Apache-2.0
// Places where dashes begin and end.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "frontmost/sheets.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using Points = std::vector<glm::dvec2>;

Page page_of(PageGroup group) {
  Page page{300, 300, "", {}};
  page.layers = {{"1 hidden", {std::move(group)}}};
  return page;
}

PageGroup dashed(const Points& points, bool is_closed, std::vector<double> dashes = {3, 1}) {
  PageGroup group{"object", {0.25, {}, std::move(dashes)}};
  group.add(points, is_closed);
  return group;
}

/// The dashes of one group.
std::vector<Points> cut(const PageGroup& group) {
  const Page page = with_real_dashes(page_of(group));
  const PageGroup& found = page.layers[0].groups[0];
  EXPECT_EQ(found.name, "object");
  EXPECT_TRUE(found.pen.dashes.empty());
  EXPECT_EQ(found.pen.width, 0.25);
  EXPECT_NO_THROW(validate(page));
  std::vector<Points> all;
  for (const PagePath& path : found.paths) {
    EXPECT_FALSE(path.is_closed);
    all.emplace_back(found.points.begin() + path.first, found.points.begin() + path.first + path.count);
  }
  return all;
}

TEST(RealDashes, BothEndsOfALineAreDrawn) {
  // The line holds three dashes of 3 and two gaps of 1.
  EXPECT_EQ(cut(dashed({{0, 5}, {11, 5}}, false)),
            (std::vector<Points>{{{0, 5}, {3, 5}}, {{4, 5}, {7, 5}}, {{8, 5}, {11, 5}}}));
  // A pattern of twice the size gives three dashes as well.
  EXPECT_EQ(cut(dashed({{5, 0}, {5, 22}}, false, {6, 2})).size(), 3u);
  // The number of periods is the nearest whole number: 10 is 10/11 of 11.
  const std::vector<Points> squeezed = cut(dashed({{0, 0}, {10, 0}}, false));
  ASSERT_EQ(squeezed.size(), 3u);
  EXPECT_NEAR(squeezed[0][1].x, 30 / 11.0, 1e-12);
  EXPECT_EQ(squeezed[2][1], glm::dvec2(10, 0));
  // The line is too short for a gap.
  EXPECT_EQ(cut(dashed({{0, 0}, {4, 0}}, false)), (std::vector<Points>{{{0, 0}, {4, 0}}}));
}

TEST(RealDashes, CornersAreDrawnThrough) {
  EXPECT_EQ(cut(dashed({{0, 0}, {7, 0}, {7, 7}}, false)),
            (std::vector<Points>{{{0, 0}, {3, 0}}, {{4, 0}, {7, 0}, {7, 3}}, {{7, 4}, {7, 7}}}));
  const std::vector<Points> square = cut(dashed({{0, 0}, {7, 0}, {7, 7}, {0, 7}}, true));
  ASSERT_EQ(square.size(), 4u);
  for (const Points& corner : square) {
    ASSERT_EQ(corner.size(), 3u);
    EXPECT_NEAR(glm::distance(corner[0], corner[1]), 3, 1e-12);
    EXPECT_NEAR(glm::distance(corner[1], corner[2]), 3, 1e-12);
  }
}

TEST(RealDashes, ThePatternGoesOnAroundGentleBends) {
  Points bent;
  for (int i = 0; i <= 110; ++i) bent.emplace_back(i * 0.1, 20 + 0.01 * std::sin(i));
  EXPECT_EQ(cut(dashed(bent, false)).size(), 3u);
}

TEST(RealDashes, BendsOfMoreThan25DegreesAreCorners) {
  const auto first_dash = [](double degrees) {
    const double turn = degrees * std::numbers::pi / 180;
    const std::vector<Points> dashes =
        cut(dashed({{0, 0}, {5.5, 0}, {5.5 + 5.5 * std::cos(turn), 5.5 * std::sin(turn)}}, false));
    EXPECT_EQ(dashes.size(), 3u);
    return dashes[0][1].x;
  };
  EXPECT_NEAR(first_dash(24), 3, 1e-12);            // three on 11, as on a straight line
  EXPECT_NEAR(first_dash(26), 3 * 5.5 / 7, 1e-12);  // two on each half, where one goes around the corner
}

// Testing every dash against every point would be 2e12 tests, an hour of work.
TEST(RealDashes, LongPathsOfManyPointsTakeNoLongerThanShortOnes) {
  Points spiral;
  const int count = 1'500'000;
  for (int i = 0; i <= count; ++i) {
    const double turn = i * 0.0002, radius = 140.0 * i / count;
    spiral.emplace_back(150 + radius * std::cos(turn), 150 + radius * std::sin(turn));
  }
  const std::vector<Points> dashes = cut(dashed(spiral, false, {0.015, 0.005}));
  EXPECT_NEAR(double(dashes.size()), 140 * 150 / 0.02, 2000);
  double length = 0;
  for (const Points& dash : dashes)
    for (std::size_t i = 1; i < dash.size(); ++i) length += glm::distance(dash[i - 1], dash[i]);
  EXPECT_NEAR(length, 0.75 * 140 * 150, 3);
}

TEST(RealDashes, ArcsStayArcs) {
  // A whole circle of 32 mm has eight dashes of 3 and gaps of 1, within a hair's width.
  const double radius = 16 / std::numbers::pi;
  PageGroup circle = dashed({{100 + radius, 50}, {100 - radius, 50}}, true);
  circle.bulges = {1, 1};
  const Page page = with_real_dashes(page_of(circle));
  const PageGroup& found = page.layers[0].groups[0];
  ASSERT_EQ(found.paths.size(), 8u);
  ASSERT_EQ(found.bulges.size(), found.points.size());
  EXPECT_NEAR(travel_of(page).down, 24, 1e-9);
  EXPECT_EQ(travel_of(page).arcs, 8u);
  for (const glm::dvec2& point : found.points) EXPECT_NEAR(glm::distance(point, {100, 50}), radius, 1e-12);
}

TEST(RealDashes, DotsAndDashesOfAllKindsAndWhatIsNotDashed) {
  PageGroup dot = dashed({{5, 5}}, false);
  dot.add(Points{{6, 6}, {6, 6}}, false);
  EXPECT_EQ(cut(dot), (std::vector<Points>{{{5, 5}}, {{6, 6}}}));
  // A chain line of 5, 1, 1, 1 ends with another 5.
  const std::vector<Points> chain = cut(dashed({{0, 0}, {21, 0}}, false, {5, 1, 1, 1}));
  ASSERT_EQ(chain.size(), 5u);
  EXPECT_NEAR(chain[1][0].x, 6, 1e-12);
  EXPECT_NEAR(chain[1][1].x, 7, 1e-12);
  EXPECT_EQ(chain[4][1], glm::dvec2(21, 0));
  PageGroup solid{"", {0.25, {}}};
  solid.add(Points{{0, 0}, {21, 0}}, false);
  const Page page = with_real_dashes(page_of(solid));
  EXPECT_EQ(page.layers[0].groups[0].paths.size(), 1u);
}

TEST(RealDashes, TooManyAreRefused) {
  const PageGroup group = dashed({{0, 0}, {1e5, 0}}, false, {1e-3, 1e-3});
  EXPECT_THROW((void)with_real_dashes(page_of(group)), Error);
  // A period has a thousand dashes.
  EXPECT_THROW((void)with_real_dashes(page_of(dashed({{0, 0}, {1e5, 0}}, false, std::vector<double>(2000, 1e-3)))),
               Error);
  PageGroup bad = dashed({{0, 0}, {1, 0}}, false);
  bad.paths[0].count = 9;
  EXPECT_THROW((void)with_real_dashes(page_of(bad)), Error);
}

TEST(RealDashes, StopWhenAsked) {
  PageGroup group = dashed({{0, 0}, {1e4, 0}}, false);
  for (int i = 0; i < 100; ++i) group.add(Points{{0, 1.0 + i}, {1e4, 1.0 + i}}, false);
  const CountingWatch watch(21);
  try {
    (void)with_real_dashes(page_of(group), watch.execution(0));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace frontmost::test
