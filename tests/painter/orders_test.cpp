// SPDX-License-Identifier: Apache-2.0
// Scenes with a known order, or known to have none.
#include <gmock/gmock.h>

#include "painter/painted.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;

class Orders : public testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] View view(int size = 64) const { return view_from_above(GetParam(), size); }
};
INSTANTIATE_TEST_SUITE_P(Projections, Orders, testing::Bool(),
                         [](const auto& p) { return p.param ? "Parallel" : "Perspective"; });

void add_flat(Mesh& mesh, float z) { add_triangle(mesh, {-1, -1, z}, {1, -1, z}, {0, 1, z}); }

/// A long thin triangle from one point to another, seen from above.
void add_stick(Mesh& mesh, const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 aside = glm::normalize(glm::vec3(from.y - to.y, to.x - from.x, 0)) * 0.15f;
  add_triangle(mesh, from + aside, from - aside, to);
}

/// Three sticks, each over the next: there is no order without a cut.
Mesh ring_of_three(float tilt) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    const float a = glm::radians(120.0f * float(i)), c = std::cos(a), s = std::sin(a);
    const auto turned = [&](float x, float y, float z) { return glm::vec3(c * x - s * y, s * x + c * y, z); };
    add_stick(mesh, turned(-1.2f, -0.4f, -tilt), turned(1.2f, -0.4f, tilt));
  }
  return mesh;
}

TEST_P(Orders, FarBeforeNear) {
  Mesh mesh;
  for (const float z : {0.5f, -0.5f, 0.0f}) add_flat(mesh, z);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_THAT(ids_of(found.order), ElementsAre(1, 2, 0));
  EXPECT_EQ(found.order.steps.cuts, 0u);
  EXPECT_EQ(found.unexplained + found.explained, 0u);
}

TEST_P(Orders, InOnePlaneTheLowerIdIsOnTop) {
  Mesh mesh;
  for (int i = 0; i < 4; ++i) add_flat(mesh, 0.25f);
  add_triangle(mesh, {-0.5f, -0.5f, 0.25f}, {0.5f, -0.5f, 0.25f}, {0, 0.5f, 0.25f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_THAT(ids_of(found.order), ElementsAre(4, 3, 2, 1, 0));
  EXPECT_EQ(found.unexplained + found.explained, 0u);
}

/// The far end of the long stick is farther than the small one, yet the stick lies over it.
TEST_P(Orders, ExchangesWhereDepthMisleads) {
  Mesh mesh;
  add_triangle(mesh, {-1.5f, -1, -3}, {1.5f, 0, 1}, {-1.5f, 1, -3});
  add_triangle(mesh, {1, -0.3f, -0.5f}, {1.4f, -0.3f, -0.5f}, {1.2f, 0.3f, -0.5f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_THAT(ids_of(found.order), ElementsAre(1, 0));
  EXPECT_EQ(found.order.steps.exchanges, 1u);
  EXPECT_EQ(found.unexplained, 0u);
  EXPECT_GT(painted(surfaces, view(), PaintMethod::farthest).unexplained, 0u);
}

TEST_P(Orders, ARingOfThreeIsCut) {
  const Scene scene = scene_of(ring_of_three(0.4f));
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view(128));
  EXPECT_EQ(found.order.steps.cycles, 1u);
  EXPECT_EQ(found.order.steps.largest_cycle, 3u);
  EXPECT_EQ(found.order.steps.cuts, 2u);  // the plane of one passes through both others
  EXPECT_EQ(found.order.polygons.size(), 5u);
  EXPECT_EQ(found.unexplained, 0u);
  for (const PaintMethod naive : {PaintMethod::farthest, PaintMethod::centroid})
    EXPECT_GT(painted(surfaces, view(128), naive).unexplained, 0u);
  EXPECT_EQ(painted(surfaces, view(128), PaintMethod::bsp).unexplained, 0u);
}

TEST_P(Orders, TwoThroughEachOtherAreCutOnce) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, -1}, {1, -1, 1}, {0, 1, 0});
  add_triangle(mesh, {-1, -1, 1}, {1, -1, -1}, {0, 1, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_EQ(found.order.polygons.size(), 3u);
  EXPECT_EQ(found.order.steps.cuts, 1u);
  EXPECT_EQ(found.unexplained, 0u);
}

TEST_P(Orders, SharedEdgesAndCornersNeedNoCut) {
  Mesh mesh = random_mesh(Kind::shared_grid, 200, 3);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_EQ(found.order.polygons.size(), mesh.triangles.size());
  EXPECT_EQ(found.order.steps.cycles, 0u);
  EXPECT_EQ(found.unexplained, 0u);
}

/// A vertex of one triangle lies in the middle of another's edge, in the same plane and folded.
TEST_P(Orders, TJunctionsNeedNoCut) {
  Mesh mesh;
  add_triangle(mesh, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0.5f});
  add_triangle(mesh, {-1, 0, 0}, {0, -1, 0.5f}, {0, 0, 0});
  add_triangle(mesh, {0, 0, 0}, {0, -1, 0.5f}, {1, 0, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_EQ(found.order.polygons.size(), 3u);
  EXPECT_EQ(found.order.steps.compared, 0u);
  EXPECT_EQ(found.unexplained, 0u);
}

TEST_P(Orders, WhatPassesTheEyeIsCutAtTheNearPlane) {
  Mesh mesh;
  add_triangle(mesh, {-1, -0.5f, 0}, {1, -0.5f, 0}, {0, -0.5f, 30});
  add_flat(mesh, 2);
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Painted found = painted(surfaces, view());
  EXPECT_EQ(found.unexplained, 0u);
  for (const PaintCorner& corner : found.order.corners) EXPECT_GE(corner.at.z, 1 - 1e-9);
}

TEST_P(Orders, WhatIsNotSeenIsNotThere) {
  Mesh mesh;
  add_triangle(mesh, {0, -1, 0}, {0, 1, 0}, {0, 0, 1});             // seen edge-on, in parallel projection and here
  add_triangle(mesh, {-1, -1, 20}, {1, -1, 20}, {0, 1, 20});        // behind the eye
  add_triangle(mesh, {-1, -1, -200}, {1, -1, -200}, {0, 1, -200});  // beyond the far plane
  add_triangle(mesh, {50, 50, 0}, {51, 50, 0}, {50, 51, 0});        // beside the picture
  add_triangle(mesh, {NAN, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {1, 1, 0}, {0.5f, 0.5f, 0});  // no area
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  EXPECT_TRUE(painter(surfaces, view()).polygons.empty());
}

TEST_P(Orders, CullingLeavesOut) {
  Mesh mesh;
  add_flat(mesh, 0);
  add_triangle(mesh, {-1, -1, 1}, {0, 1, 1}, {1, -1, 1});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View culled = view();
  culled.culling = Culling::back;
  EXPECT_THAT(ids_of(painter(surfaces, culled)), ElementsAre(0));
  culled.culling = Culling::front;
  EXPECT_THAT(ids_of(painter(surfaces, culled)), ElementsAre(1));
  culled.culling = Culling::both;
  EXPECT_TRUE(painter(surfaces, culled).polygons.empty());
}

TEST(Painter, BuiltInScenesAreRight) {
  for (const char* name : {"cubes", "cycle", "teapot"}) {
    SCOPED_TRACE(name);
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    for (const bool is_parallel : {false, true})
      for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp})
        EXPECT_EQ(painted(surfaces, frame(surfaces, 160, 120, {.orthographic = is_parallel}), method).unexplained, 0u);
  }
}

TEST(Painter, TooManyPiecesAreAnError) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 1));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 64, 64);
  try {
    (void)painter(surfaces, view, {.method = PaintMethod::bsp, .most_polygons = 310});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
  }
}

TEST(Painter, OrdersOfOtherSurfacesAreRefused) {
  const Scene one = scene_of(ring_of_three(0.4f)), none = scene_of({});
  const Surfaces surfaces(one), empty(none);
  PaintOrder order = painter(surfaces, view_from_above(false));
  EXPECT_THROW((void)paint(empty, order), Error);
  order.polygons[0].corner_count = 1000;
  EXPECT_THROW((void)paint(surfaces, order), Error);
  EXPECT_TRUE(painter(empty, view_from_above(false)).polygons.empty());
}

/// A sphere whose pole is a fan of triangles that miss each other by a rounding error, and so intersect: planes cut
/// them at tiny angles.
Scene pole_of_bow_ties(int sectors) {
  Mesh mesh;
  const auto at = [&](int ring, int sector) {
    const float polar = 3.14159265f * float(ring) / 4, around = 6.2831853f * float(sector) / float(sectors);
    return glm::vec3(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
  };
  for (int ring = 0; ring < 4; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      add_triangle(mesh, at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1));
      add_triangle(mesh, at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
    }
  return scene_of(mesh);
}

TEST(Painter, APoleOfBowTiesIsRight) {
  const Scene scene = pole_of_bow_ties(8);
  const Surfaces surfaces(scene);
  for (const NamedView pole : {NamedView::bottom, NamedView::top}) {
    FrameOptions options;
    options.direction = pole;
    const View view = frame(surfaces, 200, 150, options);
    for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp}) {
      EXPECT_EQ(painted(surfaces, view, method).unexplained, 0u);
    }
  }
}

/// How far a vertex lies beyond another edge of its polygon, in pixels; every polygon must be convex.
double worst_bend(const PaintOrder& order) {
  double worst = 0;
  for (const PaintPolygon& polygon : order.polygons) {
    const auto at = [&](std::size_t i) {
      return glm::dvec2(order.corners[polygon.first_corner + i % polygon.corner_count].at);
    };
    for (std::size_t side = 0; side < polygon.corner_count; ++side) {
      const glm::dvec2 way = at(side + 1) - at(side);
      if (glm::length(way) < 1e-3) continue;  // too short to have a direction
      for (std::size_t i = 0; i < polygon.corner_count; ++i) {
        const glm::dvec2 corner = at(i) - at(side);
        worst = std::max(worst, (way.x * corner.y - way.y * corner.x) / glm::length(way));
      }
    }
  }
  return worst;
}

/// Where three planes meet at tiny angles, doubles do not give the point even to a few pixels.
TEST(Painter, CornersBetweenPlanesAtTinyAnglesAreInTheirPlace) {
  const Scene scene = pole_of_bow_ties(8);
  const Surfaces surfaces(scene);
  FrameOptions options;
  options.direction = NamedView::bottom;
  const PaintOrder order = painter(surfaces, frame(surfaces, 200, 150, options));
  ASSERT_GT(order.steps.cuts, 100u);
  EXPECT_LT(worst_bend(order), 1e-6);
}

}  // namespace
}  // namespace frontmost::test
