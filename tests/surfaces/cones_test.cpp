// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <thread>

#include "support/meshes.h"
#include "surfaces/cluster_set.h"

namespace frontmost::test {
namespace {

struct Corners {
  glm::dvec3 a, b, c;
  [[nodiscard]] glm::dvec3 normal() const { return glm::cross(b - a, c - a); }
  [[nodiscard]] double altitude() const {
    return glm::length(normal()) / std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  }
};

/// Triangles of a cluster, except those whose corners coincide.
std::vector<Corners> triangles_of(const ClusterSet& set, const Cluster& cluster) {
  std::vector<Corners> triangles;
  const auto corner = [&](std::size_t number) {
    const std::size_t v = cluster.first_vertex + number;
    return glm::dvec3(set.x[v], set.y[v], set.z[v]);
  };
  for (std::size_t i = 0; i < cluster.triangle_count; ++i) {
    const std::size_t t = cluster.first_triangle + i;
    if (set.i0[t] != set.i1[t] && set.i1[t] != set.i2[t] && set.i0[t] != set.i2[t])
      triangles.push_back({corner(set.i0[t]), corner(set.i1[t]), corner(set.i2[t])});
  }
  return triangles;
}

/// Checks the cones of all clusters. \returns how many clusters have one.
std::size_t check_cones(const ClusterSet& set, const ConeArrays& cones) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.clusters.size(); ++i) {
    if (cones.altitude[i] == 0) continue;
    ++count;
    const glm::dvec3 axis(cones.x[i], cones.y[i], cones.z[i]);
    EXPECT_NEAR(glm::length(axis), 1, 1e-6);
    const double widest = std::acos(std::min(1.0, double(cones.cosine[i]))) + double(kConeRounding);
    for (const Corners& triangle : triangles_of(set, set.clusters[i])) {
      EXPECT_GE(glm::dot(glm::normalize(triangle.normal()), axis), std::cos(widest)) << "cluster " << i;
      EXPECT_LE(cones.altitude[i], triangle.altitude() * (1 + 0x1p-8)) << "cluster " << i;
    }
  }
  return count;
}

TEST(Cones, HoldTheNormalsOfAllTriangles) {
  std::size_t count = 0;
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    for (const Kind kind : all_kinds)
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        // In soups, only clusters of a few triangles have a cone.
        const Scene scene = scene_of(random_mesh(kind, 1 + int(seed) * 40, seed));
        const Surfaces surfaces(scene);
        count += check_cones(cluster_set(surfaces), make_cones(cluster_set(surfaces), {.isa = isa}));
      }
    for (const float roughness : {0.0f, 0.001f, 0.02f}) {
      const Scene scene = scene_of(bumpy_ball(30, roughness, 3));
      const Surfaces surfaces(scene);
      const std::size_t with = check_cones(cluster_set(surfaces), make_cones(cluster_set(surfaces), {.isa = isa}));
      EXPECT_GT(with, cluster_set(surfaces).clusters.size() / 2);
      count += with;
    }
  }
  EXPECT_GT(count, 200u);
}

TEST(Cones, AreTheSameForEverySizeAndMirrored) {
  const Mesh mesh = bumpy_ball(20, 0.0f, 1);
  for (const double size : {1e-25, 1e-6, 1.0, 1e6, 1e25}) {
    SCOPED_TRACE(size);
    Scene scene = scene_of(mesh);
    scene.instances[0].world_from_mesh = glm::dmat4(-size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, 0, 0, 0, 1);
    const Surfaces surfaces(scene);
    const ClusterSet& set = cluster_set(surfaces);
    const ConeArrays cones = make_cones(set, {});
    EXPECT_GT(check_cones(set, cones), set.clusters.size() * 3 / 4);
    // Cones keep pointing outwards, away from the middle.
    for (std::size_t i = 0; i < set.clusters.size(); ++i) {
      if (cones.altitude[i] == 0) continue;
      const Box box = set.boxes.get(i);
      EXPECT_GT(glm::dot(glm::vec3(cones.x[i], cones.y[i], cones.z[i]), (box.low + box.high) / float(size)), 0);
    }
  }
}

TEST(Cones, OfAPlaneAreClosed) {
  Mesh mesh;
  for (int i = 0; i < 9; ++i) add_triangle(mesh, {i, 0, 5}, {i + 1, 0, 5}, {i, 2, 5});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const ConeArrays cones = make_cones(cluster_set(surfaces), {});
  EXPECT_EQ(glm::vec3(cones.x[0], cones.y[0], cones.z[0]), glm::vec3(0, 0, 1));
  EXPECT_EQ(cones.cosine[0], 1);
  EXPECT_NEAR(cones.altitude[0], 2 / std::sqrt(5.0), 1e-6);
}

// Rounding decides the facing of a sliver, so nothing is known about its cluster.
TEST(Cones, AreNotMadeForSliversAndNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const glm::vec3 cases[][3] = {
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},         // collinear
      {{0, 0, 0}, {1, 0, 0}, {0.3f, 1e-6f, 0}},  // nearly collinear
      {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}},       // not finite
      {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},         // a point: a box without size
      {{0, 0, 0}, {3e38f, 0, 0}, {-3e38f, 3e38f, 0}},
  };
  for (const auto& corners : cases) {
    Mesh mesh;
    add_triangle(mesh, corners[0], corners[1], corners[2]);
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    for (const Isa isa : available_isas()) {
      const ConeArrays cones = make_cones(cluster_set(surfaces), {.isa = isa});
      EXPECT_EQ(cones.altitude[0], 0);
    }
  }
}

// A triangle whose corners coincide faces no direction and leaves its neighbours' cone intact.
TEST(Cones, AreMadeBesideDegenerateTriangles) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  EXPECT_GT(make_cones(cluster_set(surfaces), {}).altitude[0], 0);
}

TEST(Cones, AreMadeOnce) {
  const Scene scene = scene_of(bumpy_ball(10, 0, 1));
  const Surfaces surfaces(scene);
  const ClusterSet& set = cluster_set(surfaces);
  EXPECT_EQ(set.cones.made(), nullptr);
  const ConeArrays* const made = &set.cones.get(set, {});
  EXPECT_EQ(&set.cones.get(set, {}), made);
  EXPECT_EQ(set.cones.made(), made);
}

TEST(Cones, MayBeAskedForBySeveralThreads) {
  const Scene scene = scene_of(bumpy_ball(30, 0, 1));
  const Surfaces surfaces(scene);
  const ClusterSet& set = cluster_set(surfaces);
  std::array<const ConeArrays*, 4> found{};
  std::vector<std::thread> threads;
  for (const ConeArrays*& one : found) threads.emplace_back([&] { one = &set.cones.get(set, {.threads = 2}); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::set<const ConeArrays*>(found.begin(), found.end()).size(), 1u);
}

}  // namespace
}  // namespace frontmost::test
