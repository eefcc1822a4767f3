// SPDX-License-Identifier: Apache-2.0
// Arcs replace chords only if the chords lie on a circle. Only evenly stepped chords may leave the arc by more than the
// tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lines/strokes/parts.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using lines_detail::Chain;

using std::numbers::pi;
constexpr double degree = pi / 180, tolerance = 0.1;

Chain with_arcs(const std::vector<glm::dvec2>& points, bool is_closed = false) {
  Chain chain;
  chain.points = points;
  chain.is_closed = is_closed;
  find_arcs(chain, tolerance);
  return chain;
}

std::size_t arcs_of(const Chain& chain) {
  return std::size_t(std::count_if(chain.bulges.begin(), chain.bulges.end(), [](double b) { return b != 0; }));
}

/// The point at `part` of the way along an arc or line from a to b; the bulge is the tangent of a quarter of the turn.
glm::dvec2 on_join(const glm::dvec2& a, const glm::dvec2& b, double bulge, double part) {
  if (bulge == 0) return a + part * (b - a);
  const glm::dvec2 along = b - a, side(along.y, -along.x);
  const double turn = 4 * std::atan(bulge);
  const glm::dvec2 centre = (a + b) / 2.0 - side * (0.5 / std::tan(turn / 2)), arm = a - centre;
  const double c = std::cos(part * turn), s = std::sin(part * turn);
  return centre + glm::dvec2(arm.x * c - arm.y * s, arm.x * s + arm.y * c);
}

double distance_to_line(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const double part = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
  return glm::distance(p, a + std::clamp(part, 0.0, 1.0) * (b - a));
}

/// Greatest distance between the drawn line and the open polyline that it replaces.
double deviation(const Chain& drawn, const std::vector<glm::dvec2>& points) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < drawn.points.size(); ++i)
    for (int k = 0; k <= 64; ++k) {
      const glm::dvec2 p = on_join(drawn.points[i], drawn.points[i + 1], drawn.bulges[i], k / 64.0);
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j + 1 < points.size(); ++j)
        nearest = std::min(nearest, distance_to_line(p, points[j], points[j + 1]));
      most = std::max(most, nearest);
    }
  return most;
}

/// Points on a circle, with the steps between them in degrees.
std::vector<glm::dvec2> on_circle(double radius, const std::vector<double>& steps) {
  std::vector<glm::dvec2> points;
  double angle = 0.3;
  points.push_back(radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  for (const double step : steps) {
    angle += step * degree;
    points.push_back(radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

TEST(Arcs, LeaveALongLineBesideTinyOnesAlone) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    // One or two long chords anywhere among tiny ones; these lie about one circle, or bend by random angles one way.
    const bool is_round = random.below(2) == 0;
    std::vector<double> steps;
    const int count = 4 + random.below(6), at = random.below(count), second = random.below(count);
    for (int k = 0; k < count; ++k)
      steps.push_back(k == at || k == second ? 9 + random.within(0, 10) : 1 - random.unit());
    std::vector<glm::dvec2> points = on_circle(400, steps);
    if (!is_round) {
      glm::dvec2 p(0);
      double heading = 0;
      points = {p};
      for (const double step : steps) {
        p += step * glm::dvec2(std::cos(heading), std::sin(heading));
        points.push_back(p);
        heading += random.within(0, 9) * degree;
      }
    }
    EXPECT_LE(deviation(with_arcs(points), points), tolerance * (1 + 1e-9)) << i;
  }
}

TEST(Arcs, OfCoarselyCutCirclesAreOne) {
  for (const double step : {5.0, 10.0, 15.0, 20.0})
    for (int count = 4; count * step < 350; ++count)
      EXPECT_EQ(arcs_of(with_arcs(on_circle(400, std::vector<double>(std::size_t(count), step)))),
                count * step <= 180 ? 1u : 2u)
          << step << " " << count;
  // Vertices of another line stand on every second chord.
  std::vector<double> split;
  for (int i = 0; i < 8; ++i) split.insert(split.end(), {15.0, 3.0 + i, 12.0 - i});
  EXPECT_EQ(arcs_of(with_arcs(on_circle(400, split))), 2u);
}

TEST(Arcs, OfClosedRingsAreCirclesUnlessTheyHaveAFlat) {
  const auto ring = [](int flats) {
    // A shaft of 40 mm with flats 19 degrees wide, and steps of 4 degrees elsewhere.
    std::vector<double> steps;
    for (int i = 0; i < 2; ++i) {
      double left = 180;
      if (i < flats) steps.push_back(19), left -= 19;
      const int count = int(left / 4);
      steps.insert(steps.end(), std::size_t(count), left / count);
    }
    std::vector<glm::dvec2> points = on_circle(400, steps);
    points.pop_back();
    return points;
  };
  EXPECT_EQ(with_arcs(ring(0), true).points.size(), 2u);
  for (const int flats : {1, 2}) {
    const Chain shaft = with_arcs(ring(flats), true);
    EXPECT_EQ(arcs_of(shaft) + std::size_t(flats), shaft.points.size());
    EXPECT_GE(std::count(shaft.bulges.begin(), shaft.bulges.end(), 0.0), flats);
  }
}

}  // namespace
}  // namespace frontmost::test
