// SPDX-License-Identifier: Apache-2.0
// Scale and orientation of sheets, and views clear of title blocks.
#include <gtest/gtest.h>

#include <random>

#include "sheets/paper.h"
#include "support/seeds.h"

namespace frontmost::test {
namespace {

TEST(PlanSheet, NoViewReachesTheTitleBlockAndNoLargerStandardScaleWould) {
  std::mt19937 random(test::noted_seed(7));
  std::uniform_real_distribution<double> side(1, 300);
  int beside = 0;
  for (int round = 0; round < 500; ++round) {
    SheetOptions options;
    options.title_block.emplace();
    options.views = {NamedView::front};
    options.page = named_paper(round % 5 < 3 ? "a2" : "a4");
    const double width = side(random), height = side(random), depth = side(random);
    std::vector<detail::ViewCell> cells;
    const auto add = [&](double w, double h, int column, int row) {
      cells.push_back({glm::dvec2(-w / 2, -h / 2), glm::dvec2(w / 2, h / 2), column, row});
    };
    add(width, height, 0, 0);
    if (round % 2) add(width, depth, 0, round % 4 == 1 ? 1 : -1);
    if (round % 3) add(depth, height, 1, 0);
    const detail::SheetLayout layout(cells, glm::dvec2(15));
    const detail::SheetPlan plan = detail::plan_sheet(layout, options, true);
    const glm::dvec2 block = plan.size - glm::dvec2(190, 46) - 10.0, high = plan.size - 20.0;
    EXPECT_EQ(plan.scale, standard_scale(plan.scale));
    bool is_beside = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const glm::dvec2 from = plan.anchors[i] + cells[i].low * plan.scale,
                       to = plan.anchors[i] + cells[i].high * plan.scale;
      EXPECT_TRUE(from.x > 29.999 && from.y > 19.999 && to.x < high.x + 0.001 && to.y < high.y + 0.001) << round;
      EXPECT_FALSE(to.x > block.x + 0.001 && to.y > block.y + 0.001) << round;
      is_beside |= to.y > block.y + 0.001;
    }
    beside += is_beside;
    // At the next scale the views would not fit even as far from the block as possible, in either orientation.
    const double next = standard_scale(plan.scale * 2.6);
    ASSERT_GT(next, plan.scale);
    const glm::dvec2 upright = options.page->size;
    for (const glm::dvec2 page : {upright, glm::dvec2(upright.y, upright.x)}) {
      const glm::dvec2 low(30, 20);
      const bool fits = glm::all(glm::lessThanEqual(layout.size(next), page - 20.0 - low));
      EXPECT_FALSE(fits && layout.leaves_free(page - glm::dvec2(200, 56), next, low)) << round;
    }
  }
  EXPECT_GT(beside, 10);  // views use the space beside the block too
}

TEST(PlanSheet, PapersLieAsStandardsHaveThemWhereTheScaleIsTheSame) {
  // Views are squares of 10 mm, in a row or in a column.
  const auto is_upright = [](int columns, int rows, std::optional<double> scale, const char* paper) {
    SheetOptions options;
    options.title_block.emplace();
    options.views = {NamedView::front};
    options.scale = scale;
    if (paper) options.page = named_paper(paper);
    std::vector<detail::ViewCell> cells;
    for (int i = 0; i < columns * rows; ++i) cells.push_back({glm::dvec2(-5), glm::dvec2(5), i % columns, i / columns});
    const glm::dvec2 size = detail::plan_sheet(detail::SheetLayout(cells, glm::dvec2(15)), options, true).size;
    return size.y > size.x;
  };
  EXPECT_TRUE(is_upright(1, 1, 5, "a4"));
  EXPECT_FALSE(is_upright(1, 1, 5, "a3"));
  EXPECT_TRUE(is_upright(1, 2, 5, nullptr));  // A4
  EXPECT_FALSE(is_upright(1, 1, {}, "a2"));
  // The page turns if the scale is larger that way, or if there is no room otherwise.
  EXPECT_TRUE(is_upright(1, 2, {}, "a2"));
  EXPECT_TRUE(is_upright(1, 3, 10, "a3"));
  EXPECT_FALSE(is_upright(3, 1, 7, "a4"));
  EXPECT_TRUE(is_upright(1, 1, 5, "a3-portrait"));
}

}  // namespace
}  // namespace frontmost::test
