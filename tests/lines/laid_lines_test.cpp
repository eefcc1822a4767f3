// SPDX-License-Identifier: Apache-2.0
// Lines drawn so far: every line that may lie on a given one is found, and far fewer are examined than exist.
#include "lines/strokes/laid_lines.h"

#include <gtest/gtest.h>

#include <functional>

#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

using MakeSegment = std::function<LineSegment(Random&)>;

LineSegment towards(const glm::dvec2& begin, double angle, double length) {
  return {begin, begin + length * glm::dvec2(std::cos(angle), std::sin(angle)), 0};
}

/// A segment across the sheet, within a pixel's width.
LineSegment long_in_a_pixel(Random& random) {
  return {
      {random.within(0, 10), 1000 + random.within(0, 1)}, {3830 + random.within(0, 10), 1000 + random.within(0, 1)}, 0};
}

/// A short segment of random length, at times reversed.
LineSegment short_in_a_pixel(Random& random) {
  const glm::dvec2 begin{random.within(0, 3000), 1000 + random.within(0, 1)};
  const glm::dvec2 end{begin.x + random.within(1, 500), 1000 + random.within(0, 1)};
  return random.below(2) == 0 ? LineSegment{begin, end, 0} : LineSegment{end, begin, 0};
}

/// A segment from one common point in a random direction.
LineSegment from_a_point(Random& random) {
  const double angle = random.within(0, 6.3f);
  return towards({500, 500}, angle, random.within(1, 16));
}

/// A tiny segment in any direction.
LineSegment in_a_heap(Random& random) {
  const glm::dvec2 begin{100 + random.within(0, 4), 200 + random.within(0, 4)};
  const double angle = random.within(0, 6.3f);
  return towards(begin, angle, random.within(0.01f, 0.2f));
}

/// A segment on one of a few lines; level and upright lines are among them.
LineSegment on_few_lines(Random& random) {
  const double angle = double(random.below(8)) * 0.39269908169872414, at = random.within(0, 20);
  return towards(towards({800, 600}, angle, at).to, angle, random.within(1, 40));
}

/// A segment anywhere in the picture, of any length.
LineSegment anywhere(Random& random) {
  const glm::dvec2 begin{random.within(0, 3000), random.within(0, 2000)};
  const double angle = random.within(0, 6.3f);
  return towards(begin, angle, std::pow(10.0, random.within(-1, 3)));
}

/// A segment within a three-hundredth of the picture, whose size one far line determines.
LineSegment in_a_far_heap(Random& random) {
  if (random.below(100) == 0) return {{3000, 3000}, {3000, 3000.1}, 0};
  const glm::dvec2 begin{random.within(0, 10), random.within(0, 10)};
  const double angle = random.within(0, 6.3f);
  return towards(begin, angle, 0.1);
}

/// Parallel segments two thirds of a pixel apart, all across the sheet.
LineSegment side_by_side(Random& random) {
  const double y = 2.0 / 3.0 * double(random.below(3000));
  return {{0, y}, {3000, y + 300}, 0};
}

/// A segment across the sheet, anywhere.
LineSegment across(Random& random) {
  const glm::dvec2 begin{random.within(0, 3000), random.within(0, 2000)};
  const double angle = random.within(0, 6.3f);
  return towards(begin, angle, 800);
}

LineSegment in_a_star(Random& random) {
  const double angle = random.within(0, 6.3f);
  return towards({1500, 1000}, angle, 800);
}

/// Whether `other` must be found: long lines only if they turn by no more than the tolerance and pass near the middle.
bool is_sought(const Line& line, const Line& other, const Nearness& nearness) {
  if (!line.is_long() || !other.is_long()) return true;
  const double turn = std::abs(cross(line.along, other.along));
  const double off = std::abs(cross(other.along, (line.from + line.to) / 2.0 - other.from));
  return turn <= nearness.slope_within(line.length) && off <= nearness.apart();
}

/// Compares every line with all earlier ones. \returns how many were found that lie on others.
std::size_t expect_all_found(const std::vector<Line>& lines, double apart) {
  const Nearness nearness(apart);
  LaidLines laid(lines, nearness);
  std::size_t found = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<bool> is_visited(i, false);
    (void)laid.for_each(lines[i], [&](std::span<const std::uint32_t> numbers) {
      for (const std::uint32_t number : numbers) is_visited[number] = true;
    });
    for (std::size_t k = 0; k < i; ++k) {
      const Stretch stretch = nearness.overlap(lines[i], lines[k]);
      if (!(stretch.end > stretch.begin) || !is_sought(lines[i], lines[k], nearness)) continue;
      EXPECT_TRUE(is_visited[k]) << i << " on " << k;
      ++found;
    }
    laid.add(std::uint32_t(i), lines[i]);
  }
  return found;
}

std::vector<Line> lines_of(const MakeSegment& make, std::size_t count) {
  Random random(7);
  std::vector<Line> lines;
  while (lines.size() < count) lines.emplace_back(make(random));
  return lines;
}

TEST(LaidLines, AllThatLieOnALineAreFound) {
  const MakeSegment kinds[] = {long_in_a_pixel, short_in_a_pixel, from_a_point, in_a_heap, on_few_lines,
                               anywhere,        in_a_far_heap,    side_by_side, across,    in_a_star};
  std::size_t found = 0;
  for (std::size_t kind = 0; kind < std::size(kinds); ++kind)
    for (const double apart : {0.002, 0.13, 1.0}) {
      SCOPED_TRACE(int(kind) * 1000 + int(apart * 100));
      found += expect_all_found(lines_of(kinds[kind], tries_little ? 600 : 2000), apart);
    }
  EXPECT_GT(found, 10000u);
}

/// A piece of a long line may be short, and short lines may then lie on it at any angle.
TEST(LaidLines, PiecesOfLongLinesAreFoundAsWhatTheyAre) {
  const Line whole({{0, 0}, {1000, 0}, 0}), piece({{500, 0}, {510, 0}, 0}), other({{500, -0.3}, {510, 0.4}, 0});
  const Nearness nearness(1.0);
  LaidLines laid({whole, other}, nearness);
  laid.add(0, piece);
  std::size_t found = 0;
  (void)laid.for_each(other, [&](std::span<const std::uint32_t> numbers) { found += numbers.size(); });
  EXPECT_GT(nearness.overlap(other, piece).end, 9);
  EXPECT_GE(found, 1u);
}

std::size_t looked_at(const std::vector<Line>& lines, double apart) {
  LaidLines laid(lines, Nearness(apart));
  std::size_t sum = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    sum += laid.for_each(lines[i], [](std::span<const std::uint32_t>) {});
    laid.add(std::uint32_t(i), lines[i]);
  }
  return sum;
}

/// Without a search by place, each of 20 thousand lines would be compared with ten thousand others.
TEST(LaidLines, LookAtFewOthers) {
  struct Case {
    MakeSegment make;
    std::size_t most;  ///< allowed comparisons for each line
  };
  const Case cases[] = {{anywhere, 30}, {across, 30}, {in_a_star, 30}, {side_by_side, 100}};
  constexpr std::size_t count = 20000;
  for (std::size_t kind = 0; kind < std::size(cases); ++kind)
    for (const double apart : {0.002, 0.12}) {
      SCOPED_TRACE(int(kind) * 1000 + int(apart * 100));
      EXPECT_LT(looked_at(lines_of(cases[kind].make, count), apart), cases[kind].most * count);
    }
}

/// Lines within a cell may all be compared with each other, as the header states, but each pair only once. A heap that
/// fills its grid is looked up like any drawing.
TEST(LaidLines, LookAtNoMoreThanAllWithinACell) {
  constexpr std::size_t count = 4000;
  const std::pair<MakeSegment, std::size_t> cases[] = {{long_in_a_pixel, count * count / 2},
                                                       {short_in_a_pixel, count * count / 4},
                                                       {in_a_heap, 20 * count},
                                                       {in_a_far_heap, count * count / 2}};
  for (const auto& [make, most] : cases) EXPECT_LE(looked_at(lines_of(make, count), 0.002), most);
}

}  // namespace
}  // namespace frontmost::test
