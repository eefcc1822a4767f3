// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "frontmost/scene.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "surfaces/cluster_set.h"

namespace frontmost::test {
namespace {

/// Corners of every triangle by id, as the clusters hold them; expects every id once.
std::vector<std::array<glm::vec3, 3>> triangles_of(const ClusterSet& set, std::size_t count) {
  std::vector<std::array<glm::vec3, 3>> triangles(count);
  std::vector<int> seen(count, 0);
  for (const Cluster& cluster : set.clusters) {
    EXPECT_LE(cluster.vertex_count, Cluster::max_vertices);
    EXPECT_LE(cluster.triangle_count, Cluster::max_triangles);
    for (std::size_t t = 0; t < cluster.triangle_count; ++t) {
      const std::size_t c = cluster.first_triangle + t;
      const std::uint8_t numbers[3] = {set.i0[c], set.i1[c], set.i2[c]};
      ++seen.at(set.id[c]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LT(numbers[k], cluster.vertex_count);
        const std::size_t v = cluster.first_vertex + numbers[k];
        triangles[set.id[c]][k] = {set.x[v], set.y[v], set.z[v]};
      }
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(count));
  return triangles;
}

TEST(Surfaces, VerticesArePlacedAsOneByOne) {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 7u, 16u, 333u}) {
    glm::dmat4 place(1.0);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) place[column][row] = double(random.within(-9, 9)) * (column == 3 ? 1e4 : 1);
    std::vector<glm::vec3> from;
    for (std::size_t i = 0; i < count; ++i) from.push_back(random.point(i % 3 == 0 ? 1e-3f : 5e5f));
    // Values beyond the range of floats, and values that were never finite.
    if (count > 8) from[3].x = 3e38f, from[5].y = std::numeric_limits<float>::infinity(), from[8].z = -3e38f;
    for (const Isa isa : available_isas()) {
      std::vector<glm::vec3> to(count), same = from;
      place_vertices(place, from, to.data(), isa);
      place_vertices(place, same, same.data(), isa);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 expected = to_world(place, from[i]);
        const bool is_number = expected == expected;
        EXPECT_EQ(is_number, to[i] == to[i]) << i;
        // Without vectors, checked builds of Highway give the largest float instead of infinity.
        if (!is_number || (test::under_sanitizer && !is_finite(expected))) continue;
        EXPECT_TRUE(has_same_bits(to[i], expected)) << i;
        EXPECT_TRUE(has_same_bits(same[i], expected)) << i;
      }
    }
  }
}

TEST(Surfaces, ClustersHoldEveryTriangleOnce) {
  for (const Kind kind : {Kind::soup, Kind::shared_grid, Kind::fan, Kind::coplanar}) {
    Scene scene = scene_of(random_mesh(kind, 40'000, 1));
    scene.instances.push_back({"again", 0, glm::dmat4(2.0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1)});
    const Surfaces surfaces(scene);
    const auto triangles = triangles_of(cluster_set(surfaces), surfaces.primitive_count());
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) EXPECT_EQ(triangles[id], surfaces.corners(id));
  }
}

TEST(Surfaces, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 100'000, 2));
  const Surfaces one(scene, {.threads = 1}), four(scene, {.threads = 4});
  const ClusterSet &a = cluster_set(one), &b = cluster_set(four);
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  ASSERT_EQ(a.x.size(), b.x.size());
  EXPECT_EQ(std::memcmp(a.x.data(), b.x.data(), a.x.size() * 4), 0);
  EXPECT_EQ(std::memcmp(a.i1.data(), b.i1.data(), a.i1.size()), 0);
}

TEST(Surfaces, BoxesHoldTheirClusters) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 5000, 2));
  const Surfaces surfaces(scene);
  const ClusterSet& set = cluster_set(surfaces);
  Box all;
  for (std::size_t i = 0; i < set.clusters.size(); ++i) {
    const Box box = set.boxes.get(i);
    all.include(box);
    for (std::size_t v = 0; v < set.clusters[i].vertex_count; ++v) {
      const std::size_t at = set.clusters[i].first_vertex + v;
      EXPECT_TRUE(set.x[at] >= box.low.x && set.x[at] <= box.high.x && set.z[at] >= box.low.z &&
                  set.z[at] <= box.high.z);
    }
  }
  EXPECT_EQ(all.low, surfaces.bounds().low);
  EXPECT_EQ(all.high, surfaces.bounds().high);
}

TEST(Surfaces, BoundsOfAnInstanceAreThoseOfItsTriangles) {
  // The instances overlap, so clusters hold triangles of several instances.
  Scene scene = scene_of(random_mesh(Kind::soup, 5'000, 3));
  scene.instances.push_back({"smaller", 0, glm::dmat4(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0.1, 0.1, 0.1, 1)});
  scene.instances.push_back({"mirrored", 0, glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1)});
  scene.meshes[0].positions[7].y = std::numeric_limits<float>::quiet_NaN();
  const Surfaces surfaces(scene);
  std::vector<Box> boxes(scene.instances.size());
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const auto corners = surfaces.corners(id);
    if (!std::all_of(corners.begin(), corners.end(), [](const glm::vec3& p) { return is_finite(p); })) continue;
    for (const glm::vec3& corner : corners) boxes[surfaces.source(id).instance].include(corner);
  }
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    EXPECT_EQ(surfaces.bounds(i).low, boxes[i].low);
    EXPECT_EQ(surfaces.bounds(i).high, boxes[i].high);
  }
}

/// One surface in two file orders; in the second, neighbours are far apart, and rows end in the middle of a run.
TEST(Surfaces, ClustersAreSmallWhateverTheOrderOfTheFile) {
  Mesh mesh = random_mesh(Kind::shared_grid, 20'000, 4);  // rows of 202 triangles, two units wide
  const auto expect_small_clusters = [&] {
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    const std::size_t count = cluster_set(surfaces).clusters.size();
    EXPECT_LT(count, 20'000u / 45);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float size = cluster_set(surfaces).boxes.get(i).diagonal();
      sum += size;
      EXPECT_LT(size, 1.6);  // a row is longer; the curve leaves a flat sheet and returns elsewhere
    }
    EXPECT_LT(sum / double(count), 0.6);
  };
  expect_small_clusters();
  for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i)
    std::swap(mesh.triangles[i], mesh.triangles[i * 7919 % (i + 1)]);
  expect_small_clusters();
}

TEST(Surfaces, IdsLeadBackToInstanceMeshAndTriangle) {
  Scene scene = scene_of(random_mesh(Kind::soup, 10, 1));
  scene.meshes.push_back(random_mesh(Kind::soup, 3, 2));
  scene.meshes.emplace_back();  // an empty mesh in between takes no ids
  scene.instances = {
      {"a", 1, glm::dmat4(1)}, {"none", 2, glm::dmat4(1)}, {"b", 0, glm::dmat4(1)}, {"c", 1, glm::dmat4(1)}};
  const Surfaces surfaces(scene);
  EXPECT_EQ(surfaces.primitive_count(), 16u);
  const PrimitiveSource first = surfaces.source(0), second = surfaces.source(3), last = surfaces.source(15);
  EXPECT_EQ(first.instance, 0u);
  EXPECT_EQ(second.instance, 2u);
  EXPECT_EQ(second.mesh, 0u);
  EXPECT_EQ(second.triangle, 0u);
  EXPECT_EQ(last.instance, 3u);
  EXPECT_EQ(last.triangle, 2u);
  EXPECT_EQ(surfaces.first_primitive(3), 13u);
}

TEST(Surfaces, NonFiniteTrianglesAreDegenerateAndOutOfTheBounds) {
  Mesh mesh = random_mesh(Kind::soup, 1, 1);
  add_triangle(mesh, {std::numeric_limits<float>::infinity(), 0, 0}, {900, 0, 0}, {0, 900, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  EXPECT_EQ(surfaces.primitive_count(), 2u);
  EXPECT_LT(surfaces.bounds().high.x, 10);
  const ClusterSet& set = cluster_set(surfaces);
  const auto bad = std::size_t(std::find(set.id.begin(), set.id.end(), 1u) - set.id.begin());
  EXPECT_TRUE(set.i0[bad] == set.i1[bad] && set.i1[bad] == set.i2[bad]);

  Scene only_bad = scene_of({});
  add_triangle(only_bad.meshes[0], glm::vec3(std::nanf("")), {0, 0, 0}, {1, 0, 0});
  const Surfaces nothing(only_bad);
  EXPECT_TRUE(nothing.bounds().is_empty());
  EXPECT_EQ(nothing.primitive_count(), 1u);
}

TEST(Surfaces, RefuseBrokenScenesByName) {
  Scene scene = scene_of(random_mesh(Kind::soup, 3, 1));
  scene.meshes[0].triangles[2].y = 99;
  try {
    const Surfaces surfaces(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "test: mesh 0: triangle 2: vertex 99 is out of range, there are 9");
  }
  scene.meshes[0].triangles[2].y = 0;
  scene.instances[0].world_from_mesh[3][0] = std::nan("");
  EXPECT_THROW(Surfaces surfaces(scene), Error);
  scene.instances[0].mesh = 7;
  EXPECT_THROW(Surfaces surfaces(scene), Error);
}

// The header promises that corners() returns the drawn bits, including the sign of zero.
TEST(Surfaces, CornersKeepTheSignOfZero) {
  Mesh mesh;
  add_triangle(mesh, {-0.0f, -0.0f, 1}, {1, -0.0f, 0}, {0, 1, -0.0f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const auto drawn = triangles_of(cluster_set(surfaces), 1)[0], told = surfaces.corners(0);
  EXPECT_EQ(std::memcmp(&drawn, &told, sizeof told), 0);
}

// Singular and overflowing transforms are no error: their triangles are flat or not finite, and so invisible.
TEST(Surfaces, DegenerateTransformsHaveAStatedOutcome) {
  Scene scene = scene_of(random_mesh(Kind::soup, 50, 1));
  scene.instances[0].world_from_mesh = glm::dmat4(0.0);
  const Surfaces flat(scene);
  EXPECT_EQ(flat.primitive_count(), 50u);
  EXPECT_EQ(flat.bounds().low, glm::vec3(0));
  EXPECT_EQ(flat.bounds().high, glm::vec3(0));
  scene.instances[0].world_from_mesh = glm::dmat4(1e300);
  const Surfaces beyond(scene);
  EXPECT_TRUE(beyond.bounds().is_empty());
  EXPECT_EQ(beyond.primitive_count(), 50u);
}

TEST(Surfaces, TellTheWatchAndStopWhenItSaysSo) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 50'000, 1));
  std::vector<double> fractions;
  Watch watch;
  watch.progress = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "surfaces");
    fractions.push_back(fraction);
  };
  const Surfaces surfaces(scene, {.watch = &watch});
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.back(), 1.0);
  watch.cancelled = [] { return true; };
  EXPECT_THROW(Surfaces(scene, {.watch = &watch}), Error);
}

// A small file can reference the same vertices many times: 2e12 times here, which would take an hour.
TEST(Surfaces, VerticesThatNoTriangleUsesCostNothingPerInstance) {
  Scene scene = scene_of(random_mesh(Kind::soup, 1, 1));
  scene.meshes[0].positions.resize(2'000'000, glm::vec3(0.5f));
  scene.instances.resize(1'000'000, scene.instances[0]);
  const Surfaces surfaces(scene, {.threads = 1});
  EXPECT_EQ(surfaces.primitive_count(), 1'000'000u);
}

TEST(Surfaces, StayWithinTheirMemory) {
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 200'000, 1));
  const Surfaces surfaces(scene);
  EXPECT_LT(double(surfaces.byte_count()) / surfaces.primitive_count(), 1);
  (void)cluster_set(surfaces);
  EXPECT_LT(double(surfaces.byte_count()) / surfaces.primitive_count(), 64);
}

}  // namespace
}  // namespace frontmost::test
