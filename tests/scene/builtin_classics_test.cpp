// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "frontmost/scene.h"
#include "scene/topology.h"

namespace frontmost {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

// z of a triangle at (x, y), seen along z; none beside the triangle.
std::optional<double> height_at(const Triangle& t, const glm::dvec2& p) {
  const auto area = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  const double whole = area(t[0], t[1], t[2]);
  const double a = area(p, t[1], t[2]) / whole, b = area(t[0], p, t[2]) / whole, c = area(t[0], t[1], p) / whole;
  if (a < 0 || b < 0 || c < 0) return {};
  return a * t[0].z + b * t[1].z + c * t[2].z;
}

// Number of points of a fine grid where a is over b, and where b is over a.
std::pair<int, int> who_is_over(const Triangle& a, const Triangle& b) {
  std::pair<int, int> over{0, 0};
  for (int i = -200; i <= 200; ++i)
    for (int j = -200; j <= 200; ++j) {
      const glm::dvec2 p(i * 0.01, j * 0.01);
      const auto za = height_at(a, p), zb = height_at(b, p);
      if (za && zb) ++(*za > *zb ? over.first : over.second);
    }
  return over;
}

TEST(Cycle, EachTriangleIsPartlyOverTheNextSoThatNoOrderExists) {
  const Scene scene = builtin("cycle");
  ASSERT_EQ(scene.instances.size(), 3u);
  ASSERT_EQ(triangle_count(scene), 3u);
  std::array<Triangle, 3> t;
  for (std::size_t k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c)
      t[k][std::size_t(c)] = scene.meshes[scene.instances[k].mesh].positions[scene.meshes[k].triangles[0][c]];
  const bool forwards = who_is_over(t[0], t[1]).first > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = forwards ? (k + 1) % 3 : (k + 2) % 3;
    const auto [over, under] = who_is_over(t[k], t[next]);
    EXPECT_GT(over, 100) << "triangle " << k << " is plainly over the next";
    EXPECT_EQ(under, 0) << "and nowhere under it: they do not cut each other";
  }
}

TEST(Cycle, FacesLookAlongZ) {
  const Scene scene = builtin("cycle");
  for (const Mesh& mesh : scene.meshes) {
    const auto& p = mesh.positions;
    EXPECT_GT(glm::cross(p[1] - p[0], p[2] - p[0]).z, 0);
  }
}

TEST(Cubes, AreTwoClosedCubesOfEdgeTwoThatCutEachOther) {
  const Scene scene = builtin("cubes");
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_NE(scene.meshes[0].material_ids, scene.meshes[1].material_ids);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(test::is_oriented_manifold(mesh));
    EXPECT_EQ(test::boundary_count(mesh), 0);
    EXPECT_EQ(test::signed_volume(mesh), 6 * 8.0);
    EXPECT_NEAR(glm::determinant(instance.world_from_mesh), 1, 1e-15);
  }
  // A vertex of each lies inside the other.
  for (int inner = 0; inner < 2; ++inner) {
    const glm::dmat4 between = glm::inverse(scene.instances[std::size_t(1 - inner)].world_from_mesh) *
                               scene.instances[std::size_t(inner)].world_from_mesh;
    int inside = 0;
    for (const glm::vec3& corner : scene.meshes[0].positions) {
      const glm::dvec4 p = between * glm::dvec4(corner, 1);
      inside += std::abs(p.x) < 1 && std::abs(p.y) < 1 && std::abs(p.z) < 1;
    }
    EXPECT_EQ(inside, 1) << "corners of cube " << inner;
  }
}

}  // namespace
}  // namespace frontmost
