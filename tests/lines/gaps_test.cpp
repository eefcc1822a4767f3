// SPDX-License-Identifier: Apache-2.0
// Shapes whose faces were tessellated one by one: their rims coincide up to rounding.
#include <gtest/gtest.h>

#include <algorithm>

#include "frontmost/lines.h"
#include "support/tessellations.h"

namespace frontmost::test {
namespace {

std::size_t count_of(const std::vector<DrawnEdge>& edges, EdgeKind kind) {
  return std::size_t(std::count_if(edges.begin(), edges.end(), [&](const DrawnEdge& e) { return e.kind == kind; }));
}

std::vector<DrawnEdge> edges_of(const Scene& scene, std::optional<double> angle = std::nullopt) {
  LineOptions options;
  options.crease_angle = angle;
  return draw_lines(Surfaces(scene), frame(Surfaces(scene), 100, 100), options).edges;
}

/// Moves every vertex by up to `by`; equal positions move alike.
Mesh moved(Mesh mesh, float by, std::uint64_t seed) {
  for (glm::vec3& place : mesh.positions) {
    Random random(seed ^ std::uint64_t(std::lround(place.x * 4096)) * 73856093 ^
                  std::uint64_t(std::lround(place.y * 4096)) * 19349663 ^
                  std::uint64_t(std::lround(place.z * 4096)) * 83492791);
    place += random.point(by);
  }
  return mesh;
}

Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
  return mesh;
}

Mesh wall(int sides, double low, double high, double slope = 0) {
  Mesh mesh;
  add_sides(mesh, {at(5, low), at(5 + slope * (high - low), high)}, even_angles(sides));
  return mesh;
}

TEST(Gaps, OfRoundingDrawNothing) {
  for (const int sides : {24, 40, 90}) {
    SCOPED_TRACE(sides);
    const Mesh below = moved(wall(sides, 0, 4), 2e-5f, 1), above = moved(wall(sides, 4, 9), 2e-5f, 2);
    const std::vector<DrawnEdge> edges = edges_of(scene_of(joined(below, above)));
    // Only the ends remain, and seams where one wall is seen from within and the other is not.
    EXPECT_NEAR(double(count_of(edges, EdgeKind::boundary)), 2.0 * sides, 8);
    EXPECT_EQ(count_of(edges, EdgeKind::intersection), 0u);
    EXPECT_EQ(count_of(edges, EdgeKind::crease), 0u);
  }
}

TEST(Gaps, BetweenRimsCutOtherwiseDrawNothing) {
  const Mesh below = wall(400, 0, 4), above = wall(500, 4, 9);
  const std::vector<DrawnEdge> edges = edges_of(scene_of(joined(below, above)));
  EXPECT_NEAR(double(count_of(edges, EdgeKind::boundary)), 900, 16);
  EXPECT_EQ(count_of(edges, EdgeKind::intersection), 0u);
}

TEST(Gaps, ThatAreWideAreDrawn) {
  const Mesh below = wall(40, 0, 4), above = wall(40, 4.01, 9);
  EXPECT_EQ(count_of(edges_of(scene_of(joined(below, above))), EdgeKind::boundary), 160u);
}

TEST(Gaps, WhereTheSurfaceFoldsAreDrawn) {
  const Mesh below = moved(wall(40, 0, 4), 2e-5f, 1), above = moved(wall(40, 4, 9, 0.3), 2e-5f, 2);
  const Scene scene = scene_of(joined(below, above));
  EXPECT_EQ(count_of(edges_of(scene), EdgeKind::boundary), 160u);
  // A given angle takes precedence: the fold has 17 degrees.
  EXPECT_LT(count_of(edges_of(scene, 20 * kDegree), EdgeKind::boundary), 110u);
}

TEST(Gaps, BetweenObjectsAreDrawn) {
  Scene scene = scene_of(moved(wall(40, 0, 4), 2e-5f, 1));
  scene.meshes.push_back(moved(wall(40, 4, 9), 2e-5f, 2));
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].mesh = 1;
  EXPECT_EQ(count_of(edges_of(scene), EdgeKind::boundary), 160u);
}

TEST(Gaps, RimsThatLieOnEachOtherAreDrawn) {
  // A sheet on a sheet: both end on the same line, on the same side of it.
  Mesh mesh;
  for (const float z : {0.0f, 2e-5f}) {
    add_triangle(mesh, {0, 0, z}, {4, 0, z}, {4, 3, z});
    add_triangle(mesh, {0, 0, z}, {4, 3, z}, {0, 3, z});
  }
  // The gap has more triangles beside it than its own length allows.
  add_triangle(mesh, {0, 0, 1e-5f}, {1, 0, 1e-5f}, {0, -1, 1e-5f});
  EXPECT_GE(count_of(edges_of(scene_of(mesh)), EdgeKind::boundary), 8u);
}

TEST(Gaps, WithManySidesInOnePlaceAreDrawn) {
  Mesh mesh;
  constexpr int copies = 200, sides = 10;
  for (int i = 0; i < copies; ++i)
    for (int k = 0; k < sides; ++k) {
      const float z = float(i) * 1e-7f;
      const glm::vec3 a = turned_about_z(at(5, 0), k * 36 * kDegree),
                      b = turned_about_z(at(5, 0), (k + 1) % sides * 36 * kDegree);
      add_triangle(mesh, {0, 0, z}, a + glm::vec3(0, 0, z), b + glm::vec3(0, 0, z));
    }
  EXPECT_EQ(count_of(edges_of(scene_of(mesh)), EdgeKind::boundary), std::size_t(copies * sides));
}

}  // namespace
}  // namespace frontmost::test
