// SPDX-License-Identifier: Apache-2.0
// Grids and their divided cells: a segment visits the cells on its way, and hardly any others.
#include "lines/cell_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

/// Distance between a segment and a square, along the axis where it is greater; 0 if they meet.
double apart(const glm::dvec2& a, const glm::dvec2& b, const Square& square) {
  double least = 1e300;
  for (int i = 0; i <= 1000; ++i) {
    const glm::dvec2 p = a + (b - a) * (i / 1000.0), low(square.x, square.y);
    const glm::dvec2 off = glm::max(glm::max(low - p, p - low - square.size), glm::dvec2(0));
    least = std::min(least, std::max(off.x, off.y));
  }
  return least;
}

glm::dvec2 random_point(Random& random) {
  const float x = random.within(-3, 13);
  return {x, random.within(-3, 9)};
}

/// Divides a cell among others, then a part of the cell, and a part of that part.
CellTree divided_tree() {
  CellTree tree({{1, 2}, 2, 5, 2});
  std::uint32_t cell = 7;
  for (int depth = 0; depth < 3; ++depth) cell = tree.divide(cell) + std::uint32_t(5 * depth);
  return tree;
}

void expect_visits_all(const CellTree& tree, const glm::dvec2& a, const glm::dvec2& b, double pad) {
  std::map<std::uint32_t, PassedCell> visited;
  tree.visit_along(a, b, pad, [&](const PassedCell& passed) {
    EXPECT_TRUE(visited.emplace(passed.cell, passed).second) << "twice";
    EXPECT_LE(passed.low.x, passed.high.x);
    EXPECT_LE(passed.low.y, passed.high.y);
    return true;
  });
  for (std::uint32_t cell = 0; cell < tree.count(); ++cell) {
    const double off = apart(a, b, tree.square(cell));
    const bool is_visited = visited.count(cell) > 0;
    EXPECT_FALSE(is_visited && tree.is_divided(cell));
    if (is_visited) {
      EXPECT_LE(off, 2 * pad + 0.02) << "cell " << cell;
      EXPECT_EQ(visited[cell].square.x, tree.square(cell).x);
      EXPECT_EQ(visited[cell].square.size, tree.square(cell).size);
    } else if (!tree.is_divided(cell)) {
      EXPECT_GT(off, 0.99 * pad) << "cell " << cell;
    }
  }
}

TEST(CellTree, SegmentsVisitWhatTheyPassAndLittleMore) {
  Random random(5);
  const CellTree tree = divided_tree();
  ASSERT_EQ(tree.count(), 10u + 3 * 16);
  for (int trial = 0; trial < int(seeds(300)); ++trial) {
    const glm::dvec2 a = random_point(random);
    glm::dvec2 b = random_point(random);
    if (trial % 5 == 1) b.y = a.y;
    if (trial % 5 == 2) b.x = a.x;
    if (trial % 5 == 3) b = a + (b - a) * 1e-9;
    if (trial % 5 == 4) b.y = a.y + 1e-12;
    SCOPED_TRACE(trial);
    for (const double pad : {1e-6, 0.3}) {
      expect_visits_all(tree, a, b, pad);
      expect_visits_all(tree, b, a, pad);
    }
  }
}

TEST(CellTree, BoxesHoldWhatLiesInTheCell) {
  Random random(6);
  const CellTree tree = divided_tree();
  for (int trial = 0; trial < 300; ++trial) {
    const glm::dvec2 a = random_point(random), b = random_point(random);
    tree.visit_along(a, b, 1e-6, [&](const PassedCell& passed) {
      for (int i = 0; i <= 100; ++i) {
        const glm::dvec2 p = a + (b - a) * (i / 100.0);
        const Square& s = passed.square;
        if (p.x < s.x || p.y < s.y || p.x > s.x + s.size || p.y > s.y + s.size) continue;
        EXPECT_GE(p.x, passed.low.x - 1e-12);
        EXPECT_GE(p.y, passed.low.y - 1e-12);
        EXPECT_LE(p.x, passed.high.x + 1e-12);
        EXPECT_LE(p.y, passed.high.y + 1e-12);
      }
      return true;
    });
  }
}

TEST(CellTree, VisitsEndWhenAsked) {
  const CellTree tree = divided_tree();
  for (int most = 1; most < 8; ++most) {
    int visits = 0;
    tree.visit_along({1, 3}, {11, 5.5}, 1e-6, [&](const PassedCell&) { return ++visits < most; });
    EXPECT_EQ(visits, most);
  }
}

TEST(CellTree, ADividedCellIsTheSameWhereverItWasDivided) {
  CellTree apart_tree({{5, 4}, 2, 1, 1});
  std::uint32_t cell = 0;
  for (int depth = 0; depth < 3; ++depth) cell = apart_tree.divide(cell) + std::uint32_t(5 * depth);
  CellTree tree({{1, 2}, 2, 5, 2});
  tree.graft(7, apart_tree);
  const CellTree expected = divided_tree();
  ASSERT_EQ(tree.count(), expected.count());
  for (std::uint32_t i = 0; i < tree.count(); ++i) {
    EXPECT_EQ(tree.is_divided(i), expected.is_divided(i));
    EXPECT_EQ(tree.square(i).x, expected.square(i).x);
    EXPECT_EQ(tree.square(i).y, expected.square(i).y);
    EXPECT_EQ(tree.square(i).size, expected.square(i).size);
  }
}

TEST(SquareGrid, BoxesVisitTheSquaresThatTheyTouch) {
  const SquareGrid grid{{1, 2}, 2, 5, 2};
  std::vector<std::uint32_t> visited;
  const auto add = [&](int x, int y) { visited.push_back(grid.number(x, y)); };
  grid.visit_box({2, 3}, {6, 3.5}, 1e-6, add);
  EXPECT_EQ(visited, (std::vector<std::uint32_t>{0, 1, 2}));
  visited.clear();
  grid.visit_box({-9, -9}, {0, 99}, 0.5, add);
  EXPECT_TRUE(visited.empty());
  grid.visit_box({-9, -9}, {0.9, 99}, 0.5, add);
  EXPECT_EQ(visited, (std::vector<std::uint32_t>{0, 5}));
}

}  // namespace
}  // namespace frontmost::test
