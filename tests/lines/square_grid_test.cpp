// SPDX-License-Identifier: Apache-2.0
// Grids: a segment visits the cells on its way, and hardly any others.
#include "lines/square_grid.h"

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

constexpr SquareGrid kGrid{{1, 2}, 2, 5, 2};

void expect_visits_all(const glm::dvec2& a, const glm::dvec2& b, double pad) {
  std::map<std::uint32_t, PassedCell> visited;
  kGrid.visit_along(a, b, pad, [&](const PassedCell& passed) {
    EXPECT_TRUE(visited.emplace(passed.cell, passed).second) << "twice";
    EXPECT_LE(passed.low.x, passed.high.x);
    EXPECT_LE(passed.low.y, passed.high.y);
    return true;
  });
  for (std::uint32_t cell = 0; cell < kGrid.count(); ++cell) {
    const double off = apart(a, b, kGrid.square(cell));
    const bool is_visited = visited.count(cell) > 0;
    if (is_visited) {
      EXPECT_LE(off, 2 * pad + 0.02) << "cell " << cell;
      EXPECT_EQ(visited[cell].square.x, kGrid.square(cell).x);
      EXPECT_EQ(visited[cell].square.size, kGrid.square(cell).size);
    } else {
      EXPECT_GT(off, 0.99 * pad) << "cell " << cell;
    }
  }
}

TEST(SquareGrid, SegmentsVisitWhatTheyPassAndLittleMore) {
  Random random(5);
  for (int trial = 0; trial < int(seeds(300)); ++trial) {
    const glm::dvec2 a = random_point(random);
    glm::dvec2 b = random_point(random);
    if (trial % 5 == 1) b.y = a.y;
    if (trial % 5 == 2) b.x = a.x;
    if (trial % 5 == 3) b = a + (b - a) * 1e-9;
    if (trial % 5 == 4) b.y = a.y + 1e-12;
    SCOPED_TRACE(trial);
    for (const double pad : {1e-6, 0.3}) {
      expect_visits_all(a, b, pad);
      expect_visits_all(b, a, pad);
    }
  }
}

TEST(SquareGrid, BoxesHoldWhatLiesInTheCell) {
  Random random(6);
  for (int trial = 0; trial < 300; ++trial) {
    const glm::dvec2 a = random_point(random), b = random_point(random);
    kGrid.visit_along(a, b, 1e-6, [&](const PassedCell& passed) {
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

TEST(SquareGrid, VisitsEndWhenAsked) {
  for (int most = 1; most < 6; ++most) {
    int visits = 0;
    kGrid.visit_along({1, 3}, {11, 5.5}, 1e-6, [&](const PassedCell&) { return ++visits < most; });
    EXPECT_EQ(visits, most);
  }
}

}  // namespace
}  // namespace frontmost::test
