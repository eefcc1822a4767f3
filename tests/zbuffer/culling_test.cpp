// SPDX-License-Identifier: Apache-2.0
// Facing: the sign of N.V in object space, and the area on the screen, which decides.

#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "support/random_scene.h"
#include "view/clip.h"

namespace frontmost::test {
namespace {

View straight_on(int size, Culling culling) {
  return {size, size, 1, look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}), make_projection(0.8, 1, {1, 10}), culling};
}

std::size_t covered_samples(const Scene& scene, const View& view) {
  const Surfaces surfaces(scene);
  std::size_t count = 0;
  for (const PrimitiveId id : zbuffer(surfaces, view).primitives) count += id != no_primitive;
  return count;
}

TEST(Culling, CounterClockwiseIsFront) {
  Mesh front, back;
  add_triangle(front, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  add_triangle(back, {-1, -1, 0}, {0, 1, 0}, {1, -1, 0});
  const std::size_t all = covered_samples(scene_of(front), straight_on(64, Culling::none));
  EXPECT_GT(all, 500u);
  EXPECT_EQ(covered_samples(scene_of(front), straight_on(64, Culling::back)), all);
  EXPECT_EQ(covered_samples(scene_of(front), straight_on(64, Culling::front)), 0u);
  EXPECT_EQ(covered_samples(scene_of(front), straight_on(64, Culling::both)), 0u);
  EXPECT_EQ(covered_samples(scene_of(back), straight_on(64, Culling::none)), all);
  EXPECT_EQ(covered_samples(scene_of(back), straight_on(64, Culling::back)), 0u);
  EXPECT_EQ(covered_samples(scene_of(back), straight_on(64, Culling::front)), all);
}

// glTF 2.0, 3.7.4: a transform with a negative determinant reverses the winding, so that outside stays outside.
TEST(Culling, MirroredInstancesKeepTheirFrontFaces) {
  Mesh front;
  add_triangle(front, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  Scene scene = scene_of(front);
  scene.instances[0].world_from_mesh[0][0] = -1;
  EXPECT_GT(covered_samples(scene, straight_on(64, Culling::back)), 500u);
  EXPECT_EQ(covered_samples(scene, straight_on(64, Culling::front)), 0u);
}

// N.V = 0: the triangle is neither front nor back, and covers nothing under any culling.
TEST(Culling, EdgeOnFacesNobody) {
  Mesh mesh;
  add_triangle(mesh, {0, -1, -1}, {0, 1, -1}, {0, 0, 1});  // in the plane x = 0 that holds the eye
  for (const Culling culling : {Culling::none, Culling::back, Culling::front})
    EXPECT_EQ(covered_samples(scene_of(mesh), straight_on(64, culling)), 0u);
}

TEST(Culling, ObjectSpaceAndScreenSpaceAgreeUpToSnapping) {
  Random random(3);
  int agree = 0, within_snapping = 0;
  for (int i = 0; i < 20'000; ++i) {
    const View view = random_view(random, 640, 480);
    const ScreenTransform t(view);
    const glm::vec3 a = random.point(1), b = a + random.point(0.1f), c = a + random.point(0.1f);
    const ClippedPolygon polygon = clip_triangle(t, {a, b, c});
    if (polygon.count != 3) continue;
    const auto& v = polygon.corners;
    const std::int64_t area =
        std::int64_t(v[1].x - v[0].x) * (v[2].y - v[0].y) - std::int64_t(v[2].x - v[0].x) * (v[1].y - v[0].y);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const glm::dvec3 to_viewer = view.projection.orthographic ? -view.forward() : view.eye() - glm::dvec3(a);
    const double facing = glm::dot(normal, to_viewer);
    if ((facing > 0) == (area < 0) && (facing < 0) == (area > 0)) {
      ++agree;
      continue;
    }
    // Snapping moves a vertex by at most 0.71 units, and float rounding by less than half a unit. Both may flip a
    // triangle only if it is thinner than three units.
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, std::hypot(v[k].x - v[(k + 1) % 3].x, v[k].y - v[(k + 1) % 3].y));
    ASSERT_LE(std::abs(double(area)), 3 * (longest + 3)) << "triangle " << i;
    ++within_snapping;
  }
  EXPECT_GT(agree, 15'000);
  EXPECT_LT(within_snapping, agree / 100);
}

/// A closed, consistently wound octahedron, subdivided.
Mesh ball(int steps) {
  Mesh mesh;
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::vec3 faces[8][3] = {{x, y, z},  {y, -x, z},  {-x, -y, z},  {-y, x, z},
                                 {y, x, -z}, {-x, y, -z}, {-y, -x, -z}, {x, -y, -z}};
  for (const auto& face : faces)
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        const auto at = [&](int p, int q) {
          const float u = float(p) / float(steps), v = float(q) / float(steps);
          return glm::normalize(face[0] * (1 - u - v) + face[1] * u + face[2] * v);
        };
        add_triangle(mesh, at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < steps) add_triangle(mesh, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  return mesh;
}

TEST(Culling, BackFacesOfAClosedBodyAreNeverMissed) {
  const Scene scene = scene_of(ball(20));
  const Surfaces surfaces(scene);
  const Visible all = zbuffer(surfaces, straight_on(400, Culling::none));
  const Visible front = zbuffer(surfaces, straight_on(400, Culling::back));
  std::size_t differ = 0, seen = 0;
  for (std::size_t i = 0; i < all.keys.size(); ++i) {
    differ += all.primitives[i] != front.primitives[i];
    seen += all.primitives[i] != no_primitive;
  }
  EXPECT_GT(seen, 40'000u);
  EXPECT_EQ(differ, 0u);
  const Visible back = zbuffer(surfaces, straight_on(400, Culling::front));
  for (std::size_t i = 0; i < all.keys.size(); ++i)
    EXPECT_EQ(all.primitives[i] == no_primitive, back.primitives[i] == no_primitive);
}

}  // namespace
}  // namespace frontmost::test
