// SPDX-License-Identifier: Apache-2.0
// Traps: strips that extend a polygon under those painted later.
#include <gtest/gtest.h>

#include <cmath>

#include "painter/painted.h"
#include "painter/trapped.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

/// Area in square pixels.
double area_of(const PolygonCorners& outline) {
  double area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    area -= 0.5 * (a.x * b.y - a.y * b.x);  // y points down
  }
  return area;
}

TEST(Traps, ReachUnderWhatHidesThem) {
  Mesh mesh;
  add_square(mesh, 1, 0);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, view_from_above(true));
  const std::vector<PolygonCorners> outlines = trapped(order, 0.5);
  ASSERT_EQ(outlines.size(), 2u);
  // The diagonal has a trap under the other half; the outline of the square has none.
  EXPECT_EQ(outlines[0].size(), 5u);
  EXPECT_EQ(outlines[1].size(), 3u);
  const double diagonal = 32 * std::sqrt(2.0);
  EXPECT_NEAR(area_of(outlines[0]), 512 + 0.5 * (diagonal - 1.25), 1e-9);
  EXPECT_NEAR(area_of(outlines[1]), 512, 1e-9);
  // Under glass a trap would show.
  EXPECT_EQ(trapped(order, 0.5, Occluders::none())[0].size(), 3u);
}

/// Whether a point is inside, by counting the edges to its right, as outlines with traps are not convex.
bool holds(const PolygonCorners& outline, const glm::dvec2& at) {
  bool is_inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if ((a.y <= at.y) != (b.y <= at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)) is_inside = !is_inside;
  }
  return is_inside;
}

/// The last polygon over a point, by its id.
PrimitiveId painted_at(const VisibleParts& parts, const std::vector<PolygonCorners>& outlines, const glm::dvec2& at) {
  PrimitiveId last = no_primitive;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    if (holds(outlines[i], at)) last = parts.polygons[i].id;
  return last;
}

PaintOrder order_of_triangles(const std::vector<std::array<glm::dvec2, 3>>& triangles) {
  PaintOrder order;
  order.view = view_from_above(true);
  for (const std::array<glm::dvec2, 3>& triangle : triangles) {
    order.polygons.push_back({PrimitiveId(order.polygons.size()), 3, order.corners.size()});
    for (const glm::dvec2& at : triangle) order.corners.push_back({{at, 1}, false});
  }
  return order;
}

/// Where polygons each cover part of a pixel, the background shows through. So the first polygon extends all around a
/// vertex.
TEST(Traps, GoAroundCorners) {
  for (const int count : {3, 4, 5, 7, 12, 40}) {
    SCOPED_TRACE(count);
    const glm::dvec2 middle(32.3, 31.8);
    const auto around = [&](int k, double radius) {
      const double angle = 2 * 3.14159265358979 * k / count;
      return middle + radius * glm::dvec2(std::cos(angle), -std::sin(angle));
    };
    std::vector<std::array<glm::dvec2, 3>> fan;
    for (int k = 0; k < count; ++k) fan.push_back({middle, around(k, 25), around(k + 1, 25)});
    const std::vector<PolygonCorners> outlines = trapped(order_of_triangles(fan), 4);
    for (int y = -8; y <= 8; ++y)
      for (int x = -8; x <= 8; ++x) {
        const glm::dvec2 at = glm::dvec2(x, y) * 0.17 + glm::dvec2(0.013, 0.017);
        EXPECT_TRUE(holds(outlines[0], middle + at)) << at.x << "," << at.y;
      }
  }
}

/// A needle beside the edge ends before the edge does: the trap extends as far as there is a polygon beyond.
TEST(Traps, ReachBeyondNeedles) {
  const glm::dvec2 left(5, 20), right(60, 20), end(45, 20.05);
  const std::vector<PolygonCorners> outlines =
      trapped(order_of_triangles({{left, right, {32, 5}}, {left, end, right}, {left, {20, 45}, end}}), 4);
  for (double x = 16; x < 40; x += 0.7) EXPECT_TRUE(holds(outlines[0], {x, 22.5})) << x;
  for (double x = 46; x < 60; x += 0.7) EXPECT_FALSE(holds(outlines[0], {x, 20.06})) << x;
}

/// Cuts leave pieces without area between neighbours, which cover nothing, whenever they are painted.
TEST(Traps, ReachBeyondWhatHasNoArea) {
  const glm::dvec2 left(5, 20), right(60, 20);
  for (const bool is_first : {false, true}) {
    std::vector<std::array<glm::dvec2, 3>> triangles{{left, right, {32, 5}}, {left, {32, 35}, right}};
    triangles.insert(is_first ? triangles.begin() : triangles.begin() + 1, {left, right, left});
    const PolygonCorners upper = trapped(order_of_triangles(triangles), 4)[is_first ? 1 : 0];
    for (double x = 20; x < 45; x += 0.7) EXPECT_TRUE(holds(upper, {x, 23})) << is_first << " " << x;
  }
}

/// Two squares; a polygon painted before both fills the gap between them, once as wide as the narrowest trap.
TEST(Traps, DoNotHideWhatIsSeenInGaps) {
  for (const double gap : {0.5, 1.0, 2.0, 4.0, 16.0}) {
    PaintOrder order;
    order.view = view_from_above(true);
    const auto add_box = [&](double left, double low, double right, double high) {
      order.polygons.push_back({PrimitiveId(order.polygons.size()), 4, order.corners.size()});
      for (const glm::dvec2 at : {glm::dvec2(left, high), {right, high}, {right, low}, {left, low}})
        order.corners.push_back({{at, 1}, false});
    };
    add_box(20, 12, 20 + gap, 18);
    add_box(10, 10, 20, 20);
    add_box(20 + gap, 12, 30 + gap, 18);
    EXPECT_EQ(trapped(order, 16)[1].size(), 4u) << gap;
  }
}

/// A wedge is painted after a box beside it, with nothing beyond the wedge: the trap gets narrower with the wedge.
TEST(Traps, TaperTowardsWedges) {
  PaintOrder order;
  order.view = view_from_above(true);
  const auto add = [&](std::initializer_list<glm::dvec2> corners) {
    order.polygons.push_back({PrimitiveId(order.polygons.size()), std::uint32_t(corners.size()), order.corners.size()});
    for (const glm::dvec2 at : corners) order.corners.push_back({{at, 1}, false});
  };
  add({{10, 20}, {90, 20}, {90, 10}, {10, 10}});
  add({{10, 24}, {90, 20}, {10, 20}});
  const std::vector<PolygonCorners> outlines = trapped(order, 4);
  EXPECT_EQ(outlines[0].size(), 6u);
  // The trap stops short of the open part by a pixel, or by six tenths of the height if that is less. At the outline it
  // is inset by half of its height.
  EXPECT_NEAR(area_of(outlines[0]), 800 + 40 * (3 + 1) / 2 + 40 / 2 - 1.5 * 3 / 2, 1e-9);
}

TEST(Traps, AreNotSeen) {
  std::size_t points = 0, differing = 0, traps = 0;
  for (const Kind kind : {Kind::soup, Kind::fan, Kind::shared_grid, Kind::slivers, Kind::sheets})
    for (std::uint64_t seed = 0; seed < seeds(3); ++seed) {
      const Scene scene = scene_of(random_mesh(kind, kind == Kind::sheets ? 10 : 60, seed));
      const Surfaces surfaces(scene);
      Random random(seed + 11);
      const VisibleParts seen = visible_parts(painter(surfaces, random_view(random, 100, 80)));
      const std::vector<PolygonCorners> bare = outlines_of(seen);
      for (const double width : {0.5, 4.0}) {
        const std::vector<PolygonCorners> outlines = trapped(seen, width);
        for (std::size_t i = 0; i < outlines.size(); ++i) traps += (outlines[i].size() - bare[i].size()) / 2;
        for (int i = 0; i < 1500; ++i) {
          const double x = random.within(0, 100);
          const glm::dvec2 at(x, random.within(0, 80));
          differing += painted_at(seen, bare, at) != painted_at(seen, outlines, at);
          ++points;
        }
      }
    }
  EXPECT_GT(traps, 1000u);
  // Differences are next to outlines, as anything up to 1/1024 pixel beside a polygon counts as hidden by it.
  EXPECT_LT(double(differing), 2e-4 * double(points));
}

TEST(Traps, ThreadsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 600, 2));
  const Surfaces surfaces(scene);
  const VisibleParts seen = visible_parts(painter(surfaces, frame(surfaces, 160, 120)));
  EXPECT_EQ(trapped(seen, 4, Occluders::all(), {.threads = 1}), trapped(seen, 4, Occluders::all(), {.threads = 3}));
}

}  // namespace
}  // namespace frontmost::test
