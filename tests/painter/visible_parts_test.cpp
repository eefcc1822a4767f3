// SPDX-License-Identifier: Apache-2.0
// Visible parts of an order, for drawings.
#include <gmock/gmock.h>

#include <algorithm>

#include "painter/painted.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;

/// Area in square pixels.
template <class Order>
double area_of(const Order& order, std::size_t polygon) {
  const PaintPolygon& p = order.polygons[polygon];
  double area = 0;
  for (std::size_t i = 0; i < p.corner_count; ++i) {
    const glm::dvec3 &a = order.corners[p.first_corner + i].at,
                     &b = order.corners[p.first_corner + (i + 1) % p.corner_count].at;
    area -= 0.5 * (a.x * b.y - a.y * b.x);  // y points down
  }
  return area;
}

TEST(VisibleParts, WhatOthersHideTogetherIsLeftOut) {
  Mesh mesh;
  add_triangle(mesh, {-0.5f, -0.5f, 0}, {0.7f, -0.5f, 0}, {0, 0.5f, 0});  // behind both halves of the square
  add_square(mesh, 1, 1);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, view_from_above(true));
  EXPECT_EQ(order.polygons.size(), 3u);
  EXPECT_THAT(ids_of(visible_parts(order)), testing::UnorderedElementsAre(1, 2));
  // Glass hides nothing, and neither do two polygons together if one is glass.
  EXPECT_EQ(visible_parts(order, Occluders::where([](PrimitiveId id) { return id != 1; })).polygons.size(), 3u);
}

TEST(VisibleParts, WhatIsHiddenInPartIsCut) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0});
  add_triangle(mesh, {-1.5f, 0, 1}, {1.5f, 0, 1}, {0, 1.9f, 1});  // the half above y = 0, and more
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const VisibleParts seen = visible_parts(painter(surfaces, view_from_above(true)));
  ASSERT_EQ(seen.polygons.back().id, 1u);
  double left = 0;
  for (std::size_t i = 0; i + 1 < seen.polygons.size(); ++i) left += area_of(seen, i);
  // A unit is 16 pixels. A corner of the lower triangle's upper half shows beside the cover's slanted edge.
  EXPECT_GE(left, 256 * 1.5 - 1e-6);
  EXPECT_LT(left, 256 * 1.75);
}

template <class Order>
double area_of(const Order& order) {
  double area = 0;
  for (std::size_t i = 0; i < order.polygons.size(); ++i) area += area_of(order, i);
  return area;
}

/// A grid of squares in the square; each is `share` of its cell wide.
void add_tiles(Mesh& mesh, int side, float share) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float size = 2.0f / float(side), left = float(x) * size - 1, low = float(y) * size - 1;
      const float right = left + size * share, high = low + size * share;
      add_triangle(mesh, {left, low, 1}, {right, low, 1}, {right, high, 1});
      add_triangle(mesh, {left, low, 1}, {right, high, 1}, {left, high, 1});
    }
}

/// Cuts leave pieces without a direction, which must not hide everything below their box.
TEST(VisibleParts, APointHidesNothing) {
  Mesh mesh;
  add_square(mesh, 1, 0);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  PaintOrder order = painter(surfaces, view_from_above(true, 256));
  for (const double size : {0.0, 1e-12, 1e-10, 8e-10, 1e-8}) {
    order.polygons.push_back({0, 3, order.corners.size()});
    for (const glm::dvec2 aside : {glm::dvec2(0), glm::dvec2(0, size), glm::dvec2(size, size)})
      order.corners.push_back({{glm::dvec2(100.1, 90.7) + aside, 10}, true});
    EXPECT_NEAR(area_of(visible_parts(order)), 128 * 128, 1e-3) << size;
  }
}

/// An order of triangles, counter-clockwise as seen, in a picture of 64 by 64 pixels.
PaintOrder order_of(const std::vector<std::array<glm::dvec2, 3>>& triangles) {
  PaintOrder order;
  order.view = view_from_above(true);
  for (const std::array<glm::dvec2, 3>& triangle : triangles) {
    order.polygons.push_back({PrimitiveId(order.polygons.size()), 3, order.corners.size()});
    for (const glm::dvec2& at : triangle) order.corners.push_back({{at, 10}, false});
  }
  return order;
}

/// A triangle from the middle of the picture towards one side, where it takes 48 pixels, and on to distance `far`.
std::array<glm::dvec2, 3> wedge(const glm::dvec2& out, double far) {
  const glm::dvec2 middle(32, 32), aside(-out.y, out.x);
  return {middle, middle + far * (out + 0.75 * aside), middle + far * (out - 0.75 * aside)};
}

/// Triangles that reach the eye's plane may end any number of pixels away.
TEST(VisibleParts, CornersFarOutsideLeavePlacesWithinAsTheyAre) {
  const std::array<glm::dvec2, 3> all{{{-200, 200}, {400, 200}, {-200, -400}}};
  for (const double far : {1e3, 1e12, 1e15, 1e17, 1e20, 1e30, 5e37})
    for (const glm::dvec2 out : {glm::dvec2(1, 0), glm::dvec2(0, -1), glm::dvec2(-1, 0), glm::dvec2(0, 1)}) {
      SCOPED_TRACE(testing::Message() << far << " pixels along " << out.x << ", " << out.y);
      EXPECT_NEAR(area_of(visible_parts(order_of({wedge(out, far)}))), 0.75 * 32 * 32, 1e-7);
      EXPECT_NEAR(area_of(visible_parts(order_of({all, wedge(out, far)}))), 64 * 64, 1e-7);
    }
}

TEST(VisibleParts, CornersFarOutsideLeaveDepthsWithinAsTheyAre) {
  PaintOrder order = order_of({wedge({1, 0}, 1e8)});
  order.view = view_from_above(false);
  for (const std::size_t far : {1, 2}) order.corners[far].at.z = 100;
  const VisibleParts seen = visible_parts(order);
  ASSERT_EQ(seen.corners.size(), 3u);
  for (const PaintCorner& corner : seen.corners)
    EXPECT_NEAR(corner.at.z, 1 / (0.1 - 0.09 * (corner.at.x - 32) / 1e8), 1e-7);  // 1 / z is even on the screen
}

/// If all vertices of a triangle are far away, its edges are known only to a few pixels.
TEST(VisibleParts, NoCornerIsOutsideThePicture) {
  Random random(9);
  std::size_t seen = 0;
  for (std::uint64_t i = 0; i < seeds(2000); ++i) {
    std::array<glm::dvec2, 3> triangle;
    for (glm::dvec2& at : triangle)
      for (int axis = 0; axis < 2; ++axis)
        at[axis] = (random.below(2) == 0 ? -1 : 1) * std::pow(10.0, random.below(38)) * (1 + random.below(9));
    const glm::dvec2 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
    if (u.x * v.y > u.y * v.x) std::swap(triangle[1], triangle[2]);  // y points down
    for (const PaintCorner& corner : visible_parts(order_of({triangle})).corners) {
      ++seen;
      EXPECT_GE(std::min(corner.at.x, corner.at.y), -1.0 / 1024);
      EXPECT_LE(std::max(corner.at.x, corner.at.y), 64 + 1.0 / 1024);
    }
  }
  EXPECT_GT(seen, seeds(2000) / 4);
}

TEST(VisibleParts, LargePolygonsAreCutAmongManySmallOnes) {
  Mesh mesh;
  add_square(mesh, 1, 0);
  add_tiles(mesh, 32, 0.5f);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const VisibleParts seen = visible_parts(painter(surfaces, view_from_above(true, 256)));
  double square = 0;
  for (std::size_t i = 0; i < seen.polygons.size(); ++i)
    if (seen.polygons[i].id < 2) square += area_of(seen, i);
  // Pieces stay whose removal would leave slivers, where the grid passes close to a small square.
  EXPECT_GE(square, 128 * 128 * 0.75 - 1e-3);
  EXPECT_LT(square, 128 * 128 * 0.82);
}

TEST(VisibleParts, LargePolygonsGoWhereManySmallOnesHideThem) {
  Mesh mesh;
  add_square(mesh, 0.999f, 0);
  add_tiles(mesh, 32, 1);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const VisibleParts seen = visible_parts(painter(surfaces, view_from_above(true, 256)));
  EXPECT_EQ(seen.polygons.size(), 2048u);
  for (const PaintPolygon& polygon : seen.polygons) EXPECT_GE(polygon.id, 2u);
}

/// The areas add up to the covered area of the scene, and a little more beside slivers.
TEST(VisibleParts, HardlyAnythingIsPaintedTwice) {
  for (const Kind kind : {Kind::soup, Kind::shared_grid, Kind::through_eye, Kind::sheets}) {
    SCOPED_TRACE(int(kind));
    const Scene scene = scene_of(random_mesh(kind, 60, 3));
    const Surfaces surfaces(scene);
    Random random(8);
    View view = random_view(random, 96, 96);
    view.samples = 16;
    const Visible picture = zbuffer(surfaces, view);
    const auto covered = std::count_if(picture.primitives.begin(), picture.primitives.end(),
                                       [](PrimitiveId id) { return id != no_primitive; });
    const double expected = double(covered) / 16, found = area_of(visible_parts(painter(surfaces, view)));
    EXPECT_GT(found, 0.996 * expected);
    EXPECT_LT(found, 1.1 * expected);
  }
}

TEST(VisibleParts, ThePictureIsTheSame) {
  std::size_t samples = 0, differing = 0;
  for (const Kind kind : {Kind::soup, Kind::fan, Kind::shared_grid, Kind::sheets, Kind::through_eye})
    for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
      SCOPED_TRACE(seed);
      Random random(seed + 40);
      const Scene scene = scene_of(random_mesh(kind, kind == Kind::sheets ? 12 : 50, seed));
      const Surfaces surfaces(scene);
      const View view = random_view(random, 120, 90);
      const PaintOrder order = painter(surfaces, view);
      const VisibleParts seen = visible_parts(order);
      const Visible whole = paint(surfaces, order),
                    parts = paint(surfaces, {seen.view, seen.polygons, seen.corners, {}});
      for (std::size_t i = 0; i < whole.primitives.size(); ++i) {
        differing += whole.primitives[i] != parts.primitives[i];
        ++samples;
      }
      for (const PaintCorner& corner : seen.corners) {
        EXPECT_GE(corner.at.x, -1e-3);
        EXPECT_LE(corner.at.y, 90 + 1e-3);
      }
    }
  // paint() covers from snapped vertices: samples between those and the true outline of the hiding polygon may stay
  // open.
  EXPECT_LT(double(differing), 1e-3 * double(samples));
  EXPECT_GT(samples, 10000u);
}

TEST(VisibleParts, ThreadsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 600, 2));
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, frame(surfaces, 160, 120));
  const VisibleParts one = visible_parts(order, Occluders::all(), {.threads = 1}),
                     three = visible_parts(order, Occluders::all(), {.threads = 3});
  EXPECT_EQ(ids_of(one), ids_of(three));
  ASSERT_EQ(one.corners.size(), three.corners.size());
  for (std::size_t i = 0; i < one.corners.size(); ++i) ASSERT_EQ(one.corners[i].at, three.corners[i].at);
}

}  // namespace
}  // namespace frontmost::test
