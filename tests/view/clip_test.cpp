// SPDX-License-Identifier: Apache-2.0
#include "view/clip.h"

#include <gtest/gtest.h>

#include "support/random_scene.h"

namespace frontmost::test {
namespace {

View test_view(bool orthographic) {
  View view{640, 480, 1, look_at({0.3, -0.2, 2}, {0, 0.1, 0}, {0, 1, 0}), {}, {}};
  view.projection =
      orthographic ? make_orthographic(-1, 1, -0.75, 0.75, {0.5, 6}) : make_projection(0.9, 4.0 / 3, {0.5, 6});
  return view;
}

TEST(ScreenTransform, AgreesWithTheMatrices) {
  Random random(1);
  for (const bool orthographic : {false, true}) {
    const View view = test_view(orthographic);
    const ScreenTransform t(view);
    for (int i = 0; i < 1000; ++i) {
      const glm::vec3 p = random.point(1);
      const HomogeneousVertex v = transform(t, p);
      if (!is_plain(t, v)) continue;
      const ScreenVertex s = snap(t, v);
      const glm::dvec4 eye = glm::inverse(view.world_from_eye) * glm::dvec4(p, 1);
      const glm::dvec4 clip = clip_from_eye(view.projection, reversed_depth) * eye;
      EXPECT_NEAR(s.x, clip.x / clip.w * 320 * 256, 0.75);
      EXPECT_NEAR(s.y, -clip.y / clip.w * 240 * 256, 0.75);
      const double depth = -eye.z, n = 0.5, f = 6;
      EXPECT_NEAR(s.key, orthographic ? (f - depth) / (f - n) : n / depth, 1e-6);
    }
  }
}

TEST(ScreenTransform, KeepsItsPrecisionFarFromTheOrigin) {
  View view = test_view(false);
  const glm::dvec3 far_away(4e6, -3e6, 5e6);
  view.world_from_eye[3] += glm::dvec4(far_away + glm::dvec3(0.3, 0.2, 0.1), 0);
  const ScreenTransform t(view);
  const glm::vec3 p = glm::vec3(far_away);  // exact
  const ScreenVertex s = snap(t, transform(t, p));
  const glm::dvec4 clip =
      clip_from_eye(view.projection) * (glm::inverse(view.world_from_eye) * glm::dvec4(glm::dvec3(p), 1));
  EXPECT_NEAR(s.x, clip.x / clip.w * 320 * 256, 0.75);
  EXPECT_NEAR(s.y, -clip.y / clip.w * 240 * 256, 0.75);
}

TEST(Clip, WholeTrianglesAreOnlySnapped) {
  const View view = test_view(false);
  const ScreenTransform t(view);
  const std::array<glm::vec3, 3> corners{glm::vec3(0, 0, 0), {0.2f, 0, 0}, {0, 0.2f, 0.1f}};
  const ClippedPolygon polygon = clip_triangle(t, corners);
  ASSERT_EQ(polygon.count, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const ScreenVertex expected = snap(t, transform(t, corners[i]));
    EXPECT_EQ(polygon.corners[i].x, expected.x);
    EXPECT_EQ(polygon.corners[i].key, expected.key);
  }
}

TEST(Clip, CutsLieOnThePlaneAndOutsideVanishes) {
  for (const bool orthographic : {false, true}) {
    const View view = test_view(orthographic);
    const ScreenTransform t(view);
    const glm::vec3 eye(view.eye()), ahead(view.forward());
    const std::array<glm::vec3, 3> through{eye + ahead * 2.0f, eye - ahead * 3.0f + glm::vec3(1, 0, 0),
                                           eye + ahead * 2.5f + glm::vec3(0, 1, 0)};
    const ClippedPolygon polygon = clip_triangle(t, through);
    ASSERT_EQ(polygon.count, 4);
    int on_near = 0;
    for (int i = 0; i < polygon.count; ++i) {
      EXPECT_LE(polygon.corners[std::size_t(i)].key, 1.0f);
      on_near += polygon.corners[std::size_t(i)].key == 1.0f;
    }
    EXPECT_EQ(on_near, 2);
    EXPECT_EQ(clip_triangle(t, {eye - ahead, eye - ahead * 2.0f, eye - ahead + glm::vec3(1, 0, 0)}).count, 0);
    EXPECT_EQ(clip_triangle(t, {eye + ahead * 7.0f, eye + ahead * 8.0f, eye + ahead * 9.0f + glm::vec3(1, 0, 0)}).count,
              0);
  }
}

// Both triangles at an edge must cut it at the same points, whichever direction each lists it in.
TEST(Clip, NeighboursAgreeOnTheirCommonEdge) {
  Random random(5);
  std::size_t compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const ScreenTransform t(test_view(i % 2));
    const glm::vec3 a = random.point(6), b = random.point(6), c = random.point(6), d = random.point(6);
    const ClippedPolygon left = clip_triangle(t, {a, b, c}), right = clip_triangle(t, {b, a, d});
    // The clipped edge is found by clipping it as a degenerate triangle, in each neighbour's direction.
    const ClippedPolygon forth = clip_triangle(t, {a, b, b}), back = clip_triangle(t, {b, a, a});
    const auto holds = [](const ClippedPolygon& polygon, const ScreenVertex& v) {
      for (int k = 0; k < polygon.count; ++k) {
        const ScreenVertex& w = polygon.corners[std::size_t(k)];
        if (w.x == v.x && w.y == v.y && w.key == v.key) return true;
      }
      return false;
    };
    for (int k = 0; k < forth.count; ++k) {
      const ScreenVertex& v = forth.corners[std::size_t(k)];
      EXPECT_TRUE(holds(back, v));
      EXPECT_TRUE(left.count == 0 || holds(left, v));
      EXPECT_TRUE(right.count == 0 || holds(right, v));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000u);
}

// Clipped at the near plane first, the edge between the first two vertices would end 1e16 to either side.
TEST(Clip, TrianglesBesideTheViewVanishHoweverFarTheyReach) {
  const std::array<glm::vec3, 3> triangle{glm::vec3(1.31398e11f, -1.08918e8f, 84.1228f),
                                          glm::vec3(2.08206e32f, -4.1612e-35f, -3.12502e35f),
                                          glm::vec3(2.20249e22f, 6.90475e15f, 1.11124e18f)};
  for (const double up : {0.0, 1.0}) {
    const glm::dmat4 eye = look_at({0.302734, 0.577447, 3}, {0, 0, 0}, {0, up, 1});
    const View view{32, 32, 1, eye, make_orthographic(-1, 1, -1, 1, {0.5, 100}), {}};
    for (const glm::vec3& corner : triangle)
      EXPECT_GT(std::abs(glm::dot(glm::dvec3(corner) - view.eye(), view.right())), 1e10) << "all on one side";
    EXPECT_EQ(clip_triangle(ScreenTransform(view), triangle).count, 0);
  }
}

TEST(Clip, HugeCoordinatesStayWithinTheGuardBand) {
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const ScreenTransform t(test_view(i % 2));
    const float reach = i % 3 == 0 ? 1.5e38f : 1e20f;
    const ClippedPolygon polygon = clip_triangle(t, {random.point(reach), random.point(reach), random.point(1)});
    for (int k = 0; k < polygon.count; ++k) {
      const ScreenVertex& v = polygon.corners[std::size_t(k)];
      EXPECT_LE(std::abs(v.x), kGuardBand);
      EXPECT_LE(std::abs(v.y), kGuardBand);
      EXPECT_TRUE(v.key >= 0 && v.key <= 1);
    }
  }
}

}  // namespace
}  // namespace frontmost::test
