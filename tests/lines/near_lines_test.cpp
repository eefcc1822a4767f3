// SPDX-License-Identifier: Apache-2.0
// Crowds of lines: whoever may lie on a line is found, and far fewer are asked than there are.
#include "lines/strokes/near_lines.h"

#include <gtest/gtest.h>

#include <functional>

#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

using MakeSegment = std::function<Segment(Random&)>;

Segment towards(const glm::dvec2& begin, double angle, double length) {
  return {begin, begin + length * glm::dvec2(std::cos(angle), std::sin(angle)), 0};
}

/// Through the sheet, within a pixel's width.
Segment long_in_a_pixel(Random& random) {
  return {
      {random.within(0, 10), 1000 + random.within(0, 1)}, {3830 + random.within(0, 10), 1000 + random.within(0, 1)}, 0};
}

/// Of all lengths, some turned around.
Segment short_in_a_pixel(Random& random) {
  const glm::dvec2 begin{random.within(0, 3000), 1000 + random.within(0, 1)};
  const glm::dvec2 end{begin.x + random.within(1, 500), 1000 + random.within(0, 1)};
  return random.below(2) == 0 ? Segment{begin, end, 0} : Segment{end, begin, 0};
}

/// From one point everywhere.
Segment from_a_point(Random& random) {
  const double angle = random.within(0, 6.3f);
  return towards({500, 500}, angle, random.within(1, 16));
}

/// Tiny ones, of every direction.
Segment in_a_heap(Random& random) {
  const glm::dvec2 begin{100 + random.within(0, 4), 200 + random.within(0, 4)};
  const double angle = random.within(0, 6.3f);
  return towards(begin, angle, random.within(0.01f, 0.2f));
}

/// On a few lines, again and again; level and upright ones among them.
Segment on_few_lines(Random& random) {
  const double angle = double(random.below(8)) * 0.39269908169872414, at = random.within(0, 20);
  return towards(towards({800, 600}, angle, at).to, angle, random.within(1, 40));
}

struct Asked {
  std::size_t visited = 0, all = 0;
};

/// Every line is held against all before it.
void expect_all_found(const MakeSegment& make, double apart, int count, Asked& asked) {
  const Nearness nearness(apart);
  Random random(7);
  NearLines near_lines;
  std::vector<Line> lines;
  for (int i = 0; i < count; ++i) {
    const Line line(make(random));
    std::vector<bool> is_visited(lines.size(), false);
    near_lines.for_each(SoughtLine(line, nearness), [&](std::span<const std::uint32_t> numbers) {
      for (const std::uint32_t number : numbers) is_visited[number] = true;
    });
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const Stretch stretch = nearness.overlap(line, lines[k]);
      ASSERT_TRUE(is_visited[k] || !(stretch.end > stretch.begin)) << i << " on " << k;
      asked.visited += is_visited[k];
    }
    asked.all += lines.size();
    lines.push_back(line);
    near_lines.add(std::uint32_t(i), lines, nearness);
  }
}

TEST(NearLines, FindAllThatLieOnALineAndAskFewOthers) {
  const MakeSegment kinds[] = {long_in_a_pixel, short_in_a_pixel, from_a_point, in_a_heap, on_few_lines};
  for (std::size_t kind = 0; kind < std::size(kinds); ++kind)
    for (const double apart : {0.002, 0.13, 1.0}) {
      SCOPED_TRACE(int(kind) * 1000 + int(apart * 100));
      Asked asked;
      expect_all_found(kinds[kind], apart, under_sanitizer ? 600 : 3000, asked);
      // Where a pixel counts as one line, nearly all may lie on each other.
      if (apart < 1) {
        // Those that come first are gone through one by one, and are more of few.
        EXPECT_LT(double(asked.visited), (under_sanitizer ? 0.5 : 0.25) * double(asked.all));
      }
    }
}

}  // namespace
}  // namespace frontmost::test
