// SPDX-License-Identifier: Apache-2.0
#include "view/camera/extremes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "support/random_scene.h"
#include "support/seeds.h"

namespace frontmost::test {
namespace {

/// A frustum from the origin along -z.
FilledFrustum straight() { return {glm::dmat4(1.0), {false, -0.7, 0.7, -0.4, 0.4, {}}, 0}; }
FilledFrustum turned() { return {look_at({3, -2, 1.5}, {0, 0, 0}, {0, 0, 1}), {false, -0.7, 0.7, -0.4, 0.4, {}}, 0}; }
/// A frustum with an off-axis image.
FilledFrustum sheared() {
  return {look_at({3, -2, 1.5}, {0, 0, 0}, {0, 0, 1}), {false, -0.2, 1.2, 0.1, 0.9, {}}, 0.05};
}

/// A scene of these vertices, in as many boxes as they need.
Scene cloud(const std::vector<glm::vec3>& points) {
  Mesh mesh;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) add_triangle(mesh, points[i], points[i + 1], points[i + 2]);
  return scene_of(mesh);
}

std::vector<glm::vec3> one_by_one(const std::vector<glm::vec3>& points, const FilledFrustum& frustum) {
  Extremes extremes(frustum);
  for (const glm::vec3& point : points) extremes.include(point);
  return extremes.points();
}

void expect_boxes_give_the_same(std::vector<glm::vec3> points, const FilledFrustum& frustum) {
  const std::vector<glm::vec3> expected = one_by_one(points, frustum);
  const Scene scene = cloud(points);
  const Surfaces surfaces(scene);
  Extremes whole(frustum);
  whole.include(placed_scene(surfaces));
  EXPECT_EQ(whole.points(), expected);
  Extremes by_clusters(frustum);
  by_clusters.include(cluster_set(surfaces));
  EXPECT_EQ(by_clusters.points(), expected);
  std::shuffle(points.begin(), points.end(), std::mt19937(5));
  EXPECT_EQ(one_by_one(points, frustum), expected);
}

std::vector<glm::vec3> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(test::noted_seed(seed));
  std::normal_distribution<float> draw;
  std::vector<glm::vec3> points(count);
  for (glm::vec3& p : points) p = {draw(random), draw(random), draw(random)};
  return points;
}

TEST(Extremes, OfBoxesAreThoseOfAllVertices) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::vector<glm::vec3> points = random_points(30000, seed);
    for (const FilledFrustum& frustum : {turned(), sheared()}) expect_boxes_give_the_same(points, frustum);
    for (glm::vec3& p : points) p = glm::normalize(p);  // on a sphere, every box is near the outside
    expect_boxes_give_the_same(points, turned());
    for (glm::vec3& p : points) p = p * 1e-3f + glm::vec3(1000, -4000, 70);  // many are equal in floats
    expect_boxes_give_the_same(points, turned());
  }
}

TEST(Extremes, TiesGoToTheLesserPosition) {
  std::vector<glm::vec3> grid;
  for (int y = 0; y < 99; ++y)
    for (int x = 0; x < 99; ++x) grid.emplace_back(x, y, 7);
  for (const FilledFrustum& frustum : {straight(), turned()}) expect_boxes_give_the_same(grid, frustum);
  // Seen along z, all points are nearest: the least of these are kept, and the corners in the directions of the sides.
  const std::vector<glm::vec3> kept = one_by_one(grid, straight());
  EXPECT_EQ(kept.front(), glm::vec3(0, 0, 7));
  EXPECT_LE(kept.size(), 4u);
}

TEST(Extremes, FewDirectionsKeepFewPoints) {
  const std::vector<glm::vec3> points = random_points(5000, 9);
  EXPECT_LE(one_by_one(points, turned()).size(), 132u);
  EXPECT_TRUE(Extremes(turned()).points().empty());
}

TEST(Extremes, ABoxMayChangeThemOnlyIfItReachesOut) {
  Extremes extremes(turned());
  EXPECT_TRUE(extremes.may_change_by({glm::vec3(0), glm::vec3(0)}));
  for (const glm::vec3& p : random_points(5000, 11)) extremes.include(glm::normalize(p));
  EXPECT_FALSE(extremes.may_change_by({glm::vec3(-0.5f), glm::vec3(0.5f)}));
  EXPECT_TRUE(extremes.may_change_by({glm::vec3(-0.5f), glm::vec3(0.5f, 0.5f, 3)}));
  // A kept point ties with itself.
  for (const glm::vec3& p : extremes.points()) EXPECT_TRUE(extremes.may_change_by({p, p}));
}

}  // namespace
}  // namespace frontmost::test
