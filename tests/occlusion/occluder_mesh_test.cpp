// SPDX-License-Identifier: Apache-2.0
#include "occlusion/occluder_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "occlusion/hidden_scene.h"
#include "support/meshes.h"

namespace frontmost::occlusion_detail {
namespace {

using namespace test;

OccluderMesh mesh_of(const Mesh& mesh, bool tells_parts_apart = false) {
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  return occluder_mesh(placed_scene(surfaces), 0, tells_parts_apart ? ObjectUnit::parts : ObjectUnit::instances);
}

TEST(OccluderMesh, NeighboursAreThoseAcrossSharedPlaces) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const OccluderMesh m = mesh_of(mesh);
  EXPECT_EQ(m.positions.size(), 4u);  // six vertices before welding
  ASSERT_EQ(m.triangles.size(), 2u);
  EXPECT_EQ(m.neighbours[0], glm::uvec3(no_index, no_index, 1));
  EXPECT_EQ(m.neighbours[1], glm::uvec3(0, no_index, no_index));
  EXPECT_FALSE(m.parts[0].is_closed);
}

TEST(OccluderMesh, SidesOfThreeTrianglesOrOfTwoThatRunAlikeHaveNoNeighbour) {
  Mesh fan;
  for (const float x : {1.0f, 2.0f, 3.0f}) add_triangle(fan, {0, 0, 0}, {0, 0, 1}, {x, 1, 0});
  for (const glm::uvec3& n : mesh_of(fan).neighbours) EXPECT_EQ(n, glm::uvec3(no_index));
  Mesh alike;
  add_triangle(alike, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(alike, {0, 0, 0}, {1, 0, 0}, {0, -1, 0});
  for (const glm::uvec3& n : mesh_of(alike).neighbours) EXPECT_EQ(n, glm::uvec3(no_index));
}

TEST(OccluderMesh, ABallIsClosedAndEveryTriangleIsReachedAroundItsCorners) {
  const OccluderMesh m = mesh_of(bumpy_ball(4, 0, 1));
  EXPECT_TRUE(m.parts[0].is_closed);
  for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner) {
      std::set<std::uint32_t> around{t}, expected;
      m.visit_around(t, corner, [&](std::uint32_t other) { around.insert(other); });
      const std::uint32_t vertex = m.triangles[t][corner];
      for (std::uint32_t other = 0; other < m.triangles.size(); ++other)
        for (int k = 0; k < 3; ++k)
          if (m.triangles[other][k] == vertex) expected.insert(other);
      EXPECT_EQ(around, expected);
    }
}

TEST(OccluderMesh, FlatTrianglesAreLeftOutAndWhatIsNotFiniteAsWell) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {0, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 1, 0});
  const OccluderMesh m = mesh_of(mesh);
  EXPECT_EQ(m.triangles.size(), 1u);
  EXPECT_TRUE(m.parts[0].is_whole);
}

TEST(OccluderMesh, PartsHaveTheirTrianglesAndVerticesTogether) {
  Mesh mesh;
  const Mesh ball = bumpy_ball(2, 0, 1);
  for (int i = 0; i < int(ball.triangles.size()); ++i)
    for (const float x : {0.0f, 5.0f, -5.0f}) {
      const glm::uvec3& c = ball.triangles[std::size_t(i)];
      const glm::vec3 shift(x, 0, 0);
      add_triangle(mesh, ball.positions[c.x] + shift, ball.positions[c.y] + shift, ball.positions[c.z] + shift);
    }
  const OccluderMesh m = mesh_of(mesh, true);
  ASSERT_EQ(m.parts.size(), 3u);
  for (const OccluderPart& part : m.parts) {
    EXPECT_EQ(part.triangle_count, ball.triangles.size());
    EXPECT_TRUE(part.is_closed);
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = m.triangles[part.first_triangle + t][k];
        EXPECT_GE(vertex, part.first_vertex);
        EXPECT_LT(vertex, part.first_vertex + part.vertex_count);
      }
  }
  EXPECT_NEAR(m.parts[1].bounds.centre().x, 5, 1e-6);
}

TEST(OccluderMesh, ClustersHoldEveryTriangleOnceAndReachIntoTheNext) {
  const Scene scene = scene_of(tessellated_box({1, 1, 1}, 12, 0));
  const Surfaces surfaces(scene);
  const OccluderMesh mesh = occluder_mesh(placed_scene(surfaces), 0, ObjectUnit::clusters);
  std::vector<int> times(scene.meshes[0].triangles.size(), 0);
  for (const OccluderPart& part : mesh.parts) {
    EXPECT_LE(part.own.size(), most_in_cluster);
    EXPECT_GT(part.triangle_count, part.own.size());  // in a closed surface, each part touches others
    EXPECT_TRUE(part.is_whole);
    for (const std::uint32_t t : part.own) ++times[t];
  }
  EXPECT_GE(mesh.parts.size(), times.size() / most_in_cluster);
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), std::ptrdiff_t(times.size()));
}

}  // namespace
}  // namespace frontmost::occlusion_detail
