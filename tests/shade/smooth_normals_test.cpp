// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include "frontmost/files.h"
#include "shade/geometry/geometry.h"
#include "support/meshes.h"
#include "support/models.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

bool all(std::uint32_t) { return true; }

using test::add_quad;

Mesh box() {
  Mesh mesh;
  for (const float s : {-1.0f, 1.0f}) {
    add_quad(mesh, {s, -s, -1}, {s, s, -1}, {s, s, 1}, {s, -s, 1});
    add_quad(mesh, {s, s, -1}, {-s, s, -1}, {-s, s, 1}, {s, s, 1});
    add_quad(mesh, {-1, -s, s}, {1, -s, s}, {1, s, s}, {-1, s, s});
  }
  return mesh;
}

/// An open tube about z with flat faces.
Mesh tube(int sides) {
  Mesh mesh;
  const auto at = [&](int i, float z) {
    const double angle = 2 * std::numbers::pi * (i % sides) / sides;
    return glm::vec3(std::cos(angle), std::sin(angle), z);
  };
  for (int i = 0; i < sides; ++i) add_quad(mesh, at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
  return mesh;
}

glm::vec3 normal_at(const PackedCornerNormals& normals, std::size_t triangle, std::size_t corner) {
  return glm::normalize(unpack(normals[triangle][corner]));
}

glm::vec3 facet_normal(const Mesh& mesh, std::size_t t) {
  const glm::uvec3& c = mesh.triangles[t];
  return glm::normalize(
      glm::cross(mesh.positions[c[1]] - mesh.positions[c[0]], mesh.positions[c[2]] - mesh.positions[c[0]]));
}

TEST(PackedNormal, KeepsDirectionsToAHundredthOfADegree) {
  std::mt19937 random(test::noted_seed(3));
  std::normal_distribution<float> component;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 n = glm::normalize(glm::vec3(component(random), component(random), component(random)));
    ASSERT_LT(glm::length(glm::normalize(unpack(pack(n))) - n), 0.01 * std::numbers::pi / 180);
  }
  for (int axis = 0; axis < 6; ++axis) {
    glm::vec3 n(0);
    n[axis / 2] = axis % 2 ? -1.0f : 1.0f;
    EXPECT_EQ(glm::normalize(unpack(pack(n))), n);
  }
}

TEST(SmoothNormals, ABoxKeepsItsEdges) {
  const Mesh mesh = box();
  const PackedCornerNormals normals = smooth_normals(mesh, all);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(glm::length(normal_at(normals, t, k) - facet_normal(mesh, t)), 1e-4f) << t << " " << k;
}

TEST(SmoothNormals, ATubeIsRound) {
  const Mesh mesh = tube(16);
  const PackedCornerNormals normals = smooth_normals(mesh, all);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.positions[mesh.triangles[t][int(k)]];
      // The quads may be split either way: weighting by angle makes two triangles count as much as one.
      EXPECT_LT(glm::length(normal_at(normals, t, k) - glm::vec3(p.x, p.y, 0)), 5e-3f);
    }
}

TEST(SmoothNormals, TheCreaseAngleDecides) {
  // Adjacent faces of a tube differ by 360 / sides degrees.
  for (const auto& [sides, is_round] : {std::pair(8, false), std::pair(10, true)}) {
    const Mesh mesh = tube(sides);
    const glm::vec3 n = normal_at(smooth_normals(mesh, all), 0, 0);
    EXPECT_EQ(glm::length(n - facet_normal(mesh, 0)) > 0.01f, is_round) << sides << " sides";
  }
}

TEST(SmoothNormals, NegativeZeroIsZero) {
  Mesh mesh = tube(16);
  for (glm::vec3& p : mesh.positions) p.z += 1;  // the lower rim at 0
  const PackedCornerNormals plain = smooth_normals(mesh, all);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 2)
    if (mesh.positions[i].z == 0) mesh.positions[i].z = -0.0f;
  const PackedCornerNormals mixed = smooth_normals(mesh, all);
  EXPECT_EQ(std::memcmp(plain.data(), mixed.data(), plain.size() * sizeof plain[0]), 0);
}

TEST(SmoothNormals, DoNotDependOnThreadsNorOnWhichTrianglesAreWanted) {
  const Mesh mesh = tube(30000);  // several chunks and buckets
  const PackedCornerNormals whole = smooth_normals(mesh, all, {.threads = 1});
  const auto is_wanted = [](std::uint32_t t) { return t % 7 == 3 || t > 50000; };
  for (const int threads : {1, 2, 7}) {
    const PackedCornerNormals some = smooth_normals(mesh, is_wanted, {.threads = threads});
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!is_wanted(t)) continue;
      ASSERT_EQ(std::memcmp(&whole[t], &some[t], sizeof whole[t]), 0) << t;
    }
  }
}

TEST(SmoothNormals, HostileMeshesAreSafe) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Mesh mesh = tube(16);
  const glm::vec3 p = mesh.positions[0];
  add_quad(mesh, p, p, p, p);
  add_quad(mesh, p, {nan, 0, 0}, {inf, inf, 0}, p);
  add_quad(mesh, {1e38f, 0, 0}, {-1e38f, 1e38f, 0}, {0, 0, 1e38f}, {3e38f, 3e38f, 3e38f});
  add_quad(mesh, {1e-30f, 0, 0}, {0, 1e-30f, 0}, {0, 0, 1e-30f}, {0, 0, 0});
  const PackedCornerNormals normals = smooth_normals(mesh, all);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(glm::length(normal_at(normals, t, k)), 1.0f, 1e-5f);
  // Bad vertices do not spoil their neighbours.
  EXPECT_LT(glm::length(normal_at(normals, 0, 0) - glm::vec3(p.x, p.y, 0)), 5e-3f);
  EXPECT_EQ(smooth_normals(Mesh{}, all).size(), 0u);
}

TEST(SmoothNormals, AFanOfAHundredThousandFacetsIsNoTrap) {
  Mesh mesh;
  constexpr std::uint32_t count = 100000;
  mesh.positions.push_back({0, 0, 1});
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
  }
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({0, i + 1, i + 2});
  const PackedCornerNormals normals = smooth_normals(mesh, all);
  EXPECT_GT(normal_at(normals, 0, 0).x, 0.6f);
  EXPECT_GT(normal_at(normals, count / 2, 0).x, -1.0f);
}

TEST(SmoothNormals, IndexedAndSoupBunnyAgree) {
  FRONTMOST_NEEDS_MODELS();
  const Scene indexed = load(test::model("organic/stanford-bunny.obj"));
  const Mesh& mesh = indexed.meshes[0];
  Mesh soup;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = std::uint32_t(soup.positions.size());
    for (int k = 0; k < 3; ++k) soup.positions.push_back(mesh.positions[t[k]]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const PackedCornerNormals a = smooth_normals(mesh, all), b = smooth_normals(soup, all);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
}

}  // namespace
}  // namespace frontmost::shading
