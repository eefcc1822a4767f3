// SPDX-License-Identifier: Apache-2.0
// Strokes and hatch lines for pen plotters: ends that meet, strokes in the ink of others, and the pen's way.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>

#include "frontmost/lines.h"
#include "support/meshes.h"
#include "support/random_scene.h"
#include "support/stroke_length.h"

namespace frontmost::test {
namespace {

using Polyline = std::vector<glm::dvec2>;

/// Strokes for plotters, from polylines in pixels.
class Plot {
 public:
  Plot& add(const Polyline& points, bool is_hidden = false) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      drawing_.parts.push_back(
          {std::uint32_t(drawing_.edges.size()), 0, 1, points[i], points[i + 1], is_hidden ? 1u : 0u});
      drawing_.edges.push_back({});
    }
    return *this;
  }
  Plot& add_circle(const glm::dvec2& centre, double radius, int sides) {
    Polyline points;
    for (int i = 0; i <= sides; ++i) {
      const double angle = 2 * std::numbers::pi * (i % sides) / sides;
      points.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return add(points);
  }
  [[nodiscard]] Strokes strokes(double joining, double reach = 0) const {
    if (reach == 0) return strokes(joining, Reach());
    return strokes(joining, [reach](const Stroke&) { return reach; });
  }
  using Reach = std::function<double(const Stroke&)>;
  [[nodiscard]] Strokes strokes(double joining, const Reach& reach) const {
    const Scene scene = scene_of({});
    return chain_strokes(Surfaces(scene), drawing_,
                         {.by_kind = false,
                          .by_outline = false,
                          .by_instance = false,
                          .nearest_first = true,
                          .joining = joining,
                          .ink_reach = reach});
  }

 private:
  Drawing drawing_;
};

TEST(PlotterJoins, EndsThatNearlyMeet) {
  // Three sides of a square, with gaps of 0.3 pixels at two corners; one end of the first is drawn backwards.
  Plot plot;
  plot.add({{100, 0}, {0, 0}}).add({{100, 0.3}, {100, 100}}).add({{99.7, 100}, {0, 100}});
  EXPECT_EQ(plot.strokes(0.29).strokes.size(), 3u);
  const Strokes all = plot.strokes(0.31);
  ASSERT_EQ(all.strokes.size(), 1u);
  EXPECT_FALSE(all.strokes[0].is_closed);
  // The lines stay where they are; the pen also draws the gaps.
  EXPECT_NEAR(total_length(all), 100 + 99.7 + 99.7 + 2 * 0.3, 1e-9);
  plot.add({{0, 0.2}, {0, 100}});
  const Strokes square = plot.strokes(0.31);
  ASSERT_EQ(square.strokes.size(), 1u);
  EXPECT_TRUE(square.strokes[0].is_closed);
}

TEST(PlotterJoins, LeaveAsFewStrokesAsThereCanBe) {
  // A grid of 5 x 5 points: 12 of its points have three lines, so it takes six strokes (L. Euler, 1736).
  Plot plot;
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 4; ++k) {
      plot.add({{10 * i, 10 * k}, {10 * i, 10 * k + 10}});
      plot.add({{10 * k, 10 * i}, {10 * k + 10, 10 * i}});
    }
  EXPECT_EQ(plot.strokes(0).strokes.size(), 6u);
  EXPECT_NEAR(total_length(plot.strokes(0)), 400, 1e-9);
  // Two triangles that share a vertex are one stroke.
  Plot triangles;
  triangles.add({{0, 0}, {10, 0}}).add({{10, 0}, {5, 5}}).add({{5, 5}, {0, 0}});
  triangles.add({{5, 5}, {10, 10}}).add({{10, 10}, {0, 10}}).add({{0, 10}, {5, 5}});
  EXPECT_EQ(triangles.strokes(0).strokes.size(), 1u);
}

TEST(PlotterJoins, NeverJoinAVisibleStrokeToAHiddenOne) {
  Plot plot;
  plot.add({{0, 0}, {100, 0}}).add({{100, 0}, {200, 0}}, true);
  EXPECT_EQ(plot.strokes(1).strokes.size(), 2u);
}

TEST(PlotterInk, LeavesOutWhatLiesInTheInkOfALongerStroke) {
  Plot plot;
  plot.add({{0, 0}, {100, 0}}).add({{10, 2}, {90, 2}});
  EXPECT_EQ(plot.strokes(0, 1.99).strokes.size(), 2u);
  const Strokes all = plot.strokes(0, 2);
  EXPECT_EQ(all.strokes.size(), 1u);
  EXPECT_EQ(all.covered, 1u);
  EXPECT_NEAR(total_length(all), 100, 1e-9);
}

TEST(PlotterInk, KeepsStrokesThatProtrude) {
  // The ends of ink are round: a stroke may protrude by less than the distance at its end, here by less than 2.
  for (const auto& [end, count] : {std::pair(101.9, 1u), std::pair(102.1, 2u)}) {
    Plot plot;
    plot.add({{-50, 0}, {100, 0}}).add({{10, 0.5}, {90, 0.5}, {end, 0}});
    EXPECT_EQ(plot.strokes(0, 2).strokes.size(), count) << end;
  }
  // A stroke that crosses another one, and one that goes along with another one and then leaves it.
  Plot plot;
  plot.add({{0, 0}, {100, 0}}).add({{50, -5}, {50, 5}}).add({{10, 1}, {60, 1}, {60, 8}});
  EXPECT_EQ(plot.strokes(0, 2).strokes.size(), 3u);
  EXPECT_EQ(plot.strokes(0, 2).covered, 0u);
}

TEST(PlotterInk, OfSeveralStrokesCoversTogether) {
  // Two collinear strokes cover a third one together, but not across a gap.
  for (const auto& [begin, count] : {std::pair(51.0, 2u), std::pair(56.0, 3u)}) {
    Plot plot;
    plot.add({{0, 0}, {50, 0}}).add({{begin, 0}, {begin + 50, 0}}).add({{30, 1}, {75, 1}});
    EXPECT_EQ(plot.strokes(0, 2).strokes.size(), count) << begin;
  }
}

TEST(PlotterInk, OfParallelLinesEverySecondStays) {
  // Lines 1.5 apart, of decreasing length: of two neighbours one lies in the other's ink. No paper shows between lines
  // that are 3 apart.
  Plot plot;
  for (int i = 0; i < 9; ++i) plot.add({{i, 1.5 * i}, {100 - i, 1.5 * i}});
  const Strokes all = plot.strokes(0, 2);
  EXPECT_EQ(all.strokes.size(), 5u);
  EXPECT_EQ(all.covered, 4u);
  for (const glm::dvec2& p : all.points) EXPECT_EQ(std::fmod(p.y, 3), 0);
}

TEST(PlotterInk, OfUnevenLinesLosesUpToItsReach) {
  // The shortest line lies in the ink of the first one, which ends at 2. The other line's ink begins at 2.8.
  Plot plot;
  plot.add({{0, 0}, {100, 0}}).add({{1, 4.8}, {99, 4.8}}).add({{2, 1.92}, {98, 1.92}});
  const Strokes all = plot.strokes(0, 2);
  ASSERT_EQ(all.strokes.size(), 2u);
  for (const glm::dvec2& p : all.points) EXPECT_NE(p.y, 1.92);
}

TEST(PlotterInk, OfShortLinksStaysIfItClosesAGap) {
  // A link between two junctions lies in the round ends of its neighbours, but below it only the link has ink.
  Plot gap;
  gap.add({{0, 0}, {50, 0}}).add({{50, 0}, {53, 0}}).add({{53, 0}, {100, 0}});
  gap.add({{50, 0}, {50, -40}}).add({{53, 0}, {53, -40}});
  EXPECT_EQ(gap.strokes(0, 2).covered, 0u);
  EXPECT_NEAR(total_length(gap.strokes(0, 2)), 180, 1e-9);
  // All ink of the bar of an H lies in its two sides, if they are so near to each other.
  for (const auto& [width, covered] : {std::pair(3.9, 1u), std::pair(4.1, 0u)}) {
    Plot letter;
    letter.add({{0, -40}, {0, 0}}).add({{0, 0}, {0, 40}}).add({{0, 0}, {width, 0}});
    letter.add({{width, -40}, {width, 0}}).add({{width, 0}, {width, 40}});
    EXPECT_EQ(letter.strokes(0, 2).covered, covered) << width;
  }
}

TEST(PlotterInk, ReachesAsFarAsItsOwnPen) {
  // Wide visible lines, thin hidden ones: the distances to cover are 4 and 1.
  const auto by_pen = [](const Stroke& stroke) { return stroke.is_hidden ? 1.0 : 4.0; };
  for (const auto& [apart, is_hidden, count] :
       {std::tuple(3.9, false, 1u), std::tuple(4.1, false, 2u), std::tuple(0.9, true, 1u), std::tuple(1.1, true, 2u)}) {
    Plot plot;
    plot.add({{0, 0}, {100, 0}}, is_hidden).add({{10, apart}, {90, apart}}, is_hidden);
    EXPECT_EQ(plot.strokes(0, by_pen).strokes.size(), count) << apart;
  }
  // A thin line leaves too little ink in place of a wide one.
  const auto wide_hidden = [](const Stroke& stroke) { return stroke.is_hidden ? 4.0 : 1.0; };
  Plot thin;
  thin.add({{0, 0}, {100, 0}}).add({{10, 0.9}, {90, 0.9}}, true).add({{10, -0.9}, {90, -0.9}});
  EXPECT_EQ(thin.strokes(0, wide_hidden).covered, 1u);
  // Dashed lines cover nothing.
  const auto dashed = [](const Stroke& stroke) { return stroke.is_hidden ? 0.0 : 4.0; };
  Plot plot;
  plot.add({{0, 0}, {100, 0}}, true).add({{10, 0.1}, {90, 0.1}}, true).add({{10, 20}, {90, 20}});
  plot.add({{20, 19}, {80, 19}}, true);
  EXPECT_EQ(plot.strokes(0, dashed).covered, 1u);
}

TEST(PlotterInk, OfCurvesToo) {
  Plot plot;
  plot.add_circle({100, 100}, 50, 200).add_circle({100, 100}, 48.5, 100);
  EXPECT_EQ(plot.strokes(0, 1.4).strokes.size(), 2u);
  EXPECT_EQ(plot.strokes(0, 1.6).strokes.size(), 1u);
  // A narrow ring does not cover itself.
  Plot ring;
  ring.add({{0, 0}, {50, 0}, {50, 1}, {0, 1}, {0, 0}});
  EXPECT_EQ(ring.strokes(0, 2).strokes.size(), 1u);
}

TEST(PlotterInk, OfHiddenStrokesCoversNoVisibleOne) {
  Plot plot;
  plot.add({{0, 0}, {100, 0}}, true).add({{10, 1}, {90, 1}});
  const Strokes all = plot.strokes(0, 2);
  EXPECT_EQ(all.strokes.size(), 2u);
  Plot other;
  other.add({{0, 0}, {100, 0}}).add({{10, 1}, {90, 1}}, true);
  EXPECT_EQ(other.strokes(0, 2).strokes.size(), 1u);
}

TEST(PlotterInk, CoversWhatSamplesSayThatItCovers) {
  // Against dense samples: each left-out stroke lies within the distance of those that stay, and each that stays has a
  // point farther than that from all longer ones that stay. The points are those of its centre line, or also of both
  // rims if it is short.
  constexpr double reach = 3;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<Polyline> lines;
    for (int i = 0; i < 60; ++i) {
      const glm::dvec2 from(random.within(0, 60), random.within(0, 60));
      const double angle = random.within(0, 6.2f), length = random.within(1, 12);
      lines.push_back({from, from + length * glm::dvec2(std::cos(angle), std::sin(angle))});
    }
    Plot plot;
    for (const Polyline& line : lines) plot.add(line);
    const Strokes all = plot.strokes(0, reach);
    ASSERT_EQ(all.strokes.size() + all.covered, lines.size());
    const auto distance = [](const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
      const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      return glm::distance(p, a + t * (b - a));
    };
    std::vector<Polyline> kept;
    for (const Stroke& stroke : all.strokes) kept.push_back({all.points[stroke.first], all.points[stroke.first + 1]});
    for (const Polyline& line : lines) {
      const bool stays = std::any_of(kept.begin(), kept.end(), [&](const Polyline& other) {
        return other == line || (other[0] == line[1] && other[1] == line[0]);
      });
      const double length = glm::distance(line[0], line[1]);
      double farthest = 0;
      for (int i = 0; i <= 1000; ++i) {
        const glm::dvec2 along = line[1] - line[0], across = glm::dvec2(-along.y, along.x) * (reach / length);
        for (const double side : {-1.0, 0.0, 1.0}) {
          if (side != 0 && length > 2 * reach) continue;
          const glm::dvec2 p = line[0] + along * (i / 1000.0) + side * across;
          double nearest = 1e9;
          for (const Polyline& other : kept)
            if (glm::distance(other[0], other[1]) > length) {
              nearest = std::min(nearest, distance(p, other[0], other[1]));
            }
          farthest = std::max(farthest, nearest);
        }
      }
      if (stays) {
        EXPECT_GT(farthest, reach - 1e-2) << seed;
      } else {
        EXPECT_LT(farthest, reach + 1e-5) << seed;
      }
    }
  }
}

TEST(PlotterInk, RefusesDistancesOutOfRange) {
  Plot plot;
  plot.add({{0, 0}, {100, 0}});
  for (const double bad : {-1.0, 2000.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)plot.strokes(0, bad), Error);
    EXPECT_THROW((void)plot.strokes(bad, 0), Error);
  }
}

TEST(PlotterHatching, GoesOnFromSetToSet) {
  // Four small plates far apart, all dark. With one order for each set, the pen visits each plate three times.
  Mesh mesh;
  for (const glm::vec2& at : {glm::vec2(-1.5f, -1.5f), {1.3f, -1.5f}, {1.3f, 1.3f}, {-1.5f, 1.3f}})
    add_quad(mesh, {at, 0}, {at.x + 0.2f, at.y, 0}, {at.x + 0.2f, at.y + 0.2f, 0}, {at.x, at.y + 0.2f, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 400;
  view.world_from_eye = look_at({0, 0, 10}, glm::dvec3(0), {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {0.5, 50});
  HatchOptions options{.sets = hatch_sets(4, 0.7), .by_instance = false, .nearest_first = true};
  options.tone.to_light = glm::dvec3(1, 0, 0.01);
  const std::vector<HatchLine> lines = hatch(surfaces, view, options);
  ASSERT_GT(lines.size(), 50u);
  double travel = 0;
  std::size_t long_moves = 0, sets = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double move = glm::distance(lines[i - 1].to, lines[i].from);
    travel += move;
    long_moves += move > 100;
    sets += lines[i].set != lines[i - 1].set;
  }
  EXPECT_EQ(long_moves, 3u);
  EXPECT_GT(sets, 8u);  // every set is on every plate
  EXPECT_LT(travel, 3 * 290 + 6 * double(lines.size()));
}

}  // namespace
}  // namespace frontmost::test
