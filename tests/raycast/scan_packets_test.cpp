// SPDX-License-Identifier: Apache-2.0
// Scans are cast in packets, and find to the bit what every ray finds alone.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/raycast.h"
#include "indexed_scene.h"
#include "support/cutout_scene.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

constexpr double half_turn = 3.14159265358979323846;

/// Casts the rays one by one, by the rules of single rays.
RangeScan scan_ray_by_ray(const RayIndex& index, const RayCamera& camera) {
  RangeScan scan{camera, grid_of(camera).x, grid_of(camera).y, {}, {}};
  scan.primitives = Buffer<PrimitiveId>(std::size_t(scan.width) * std::size_t(scan.height));
  scan.ranges = Buffer<float>(scan.primitives.size());
  for (int y = 0; y < scan.height; ++y)
    for (int x = 0; x < scan.width; ++x) {
      const Ray ray = ray_of(camera, x, y);
      const RayHit hit = closest_hit(index, ray);
      scan.primitives[scan.index(x, y)] = hit.primitive;
      scan.ranges[scan.index(x, y)] =
          hit ? float(hit.t * glm::length(glm::dvec3(ray.direction))) : std::numeric_limits<float>::infinity();
    }
  return scan;
}

std::size_t expect_as_ray_by_ray(const RayIndex& index, const RayCamera& camera) {
  const RangeScan alone = scan_ray_by_ray(index, camera);
  std::size_t met = 0;
  for (const PrimitiveId id : alone.primitives) met += id != no_primitive;
  for (const Isa isa : available_isas()) {
    const RangeScan together = scan(index, camera, {.threads = 2, .isa = isa});
    for (std::size_t i = 0; i < alone.ranges.size(); ++i) {
      EXPECT_EQ(together.primitives[i], alone.primitives[i]) << "ray " << i;
      EXPECT_EQ(together.ranges[i], alone.ranges[i]) << "ray " << i;
      if (testing::Test::HasFailure()) return 0;
    }
  }
  return met;
}

/// Directions within a cone, all over the sphere, at corners of the grid, and some of length zero.
RayPattern mixed_pattern(std::uint64_t seed) {
  Random random(seed);
  RayPattern pattern;
  for (int i = 0; i < 200; ++i) pattern.directions.push_back(glm::vec3(0, 0, -3) + random.point(i < 100 ? 0.1f : 6.0f));
  for (int x = -4; x <= 4; ++x)
    for (int y = -4; y <= 4; ++y) pattern.directions.emplace_back(float(x) / 8, float(y) / 8, -1);
  pattern.directions[150] = glm::vec3(0);
  pattern.directions[40].x = std::numeric_limits<float>::infinity();
  return pattern;
}

std::vector<RayCamera> cameras_at(const glm::dvec3& eye, std::uint64_t seed) {
  const glm::dmat4 level = look_at(eye, eye + glm::dvec3(0, 0, -1), {0, 1, 0});
  const glm::dmat4 turned = look_at(eye, eye + glm::dvec3(1, 0.3, -0.2), {0, 1, 0});
  return {{Lidar{ring_elevations(17, -0.5, 0.4), 90}, level},
          {Lidar{ring_elevations(3, -1, 1), 256}, turned},
          {Panorama{75, 38}, turned},
          {Panorama{7, 5}, level},
          {Fisheye{50, 41, 1.3 * half_turn}, turned},
          {mixed_pattern(seed), level}};
}

TEST(ScanPackets, FindWhatEveryRayFindsAlone) {
  const int seeds = tries_little ? 1 : 2;
  const std::size_t eyes = tries_little ? 1 : 3;
  std::size_t met = 0;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < std::uint64_t(seeds); ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << int(kind) << " seed " << seed);
      const Indexed of(scene_of(random_mesh(kind, 600, seed)));
      // Origins: within the triangles, at a triangle's vertex, and at a corner of the grids.
      const glm::dvec3 all[] = {{0.03, -0.1, 0.2}, glm::dvec3(of.surfaces.corners(0)[1]), {0.25, 0.5, 1}};
      for (const glm::dvec3& eye : std::span(all).first(eyes))
        for (const RayCamera& camera : cameras_at(eye, seed)) met += expect_as_ray_by_ray(of.index, camera);
      ASSERT_FALSE(HasFailure());
    }
  EXPECT_GT(met, 25'000u * eyes * std::size_t(seeds));
}

TEST(ScanPackets, SeeThroughTheSameHoles) {
  for (const Cut cut : {Cut::all, Cut::half})
    for (const Kind kind : {Kind::soup, Kind::sheets, Kind::shared_grid})
      for (const float cutoff : {0.3f, 0.8f}) {
        const Indexed of(cutout_scene(random_mesh(kind, 500, 5), cut, cutoff, 7));
        for (const RayCamera& camera : cameras_at({0.03, -0.1, 1.2}, 3)) (void)expect_as_ray_by_ray(of.index, camera);
        ASSERT_FALSE(HasFailure());
      }
}

/// Each ray may hit more triangles first than a packet records.
TEST(ScanPackets, ManyHolesBehindEachOtherAreAskedForOneByOne) {
  Mesh mesh;
  for (int i = 0; i < 700; ++i) {
    const float z = -1 - 0.01f * float(i);
    add_triangle(mesh, {-9, -9, z}, {18, -9, z}, {-9, 18, z});
  }
  const Indexed of(cutout_scene(std::move(mesh), Cut::all, 0.5f, 11));
  EXPECT_GT(expect_as_ray_by_ray(of.index, {Fisheye{30, 30, 0.8}}), 100u);
}

TEST(ScanPackets, SurfacesInOnePlaceGoToTheLowerId) {
  Mesh mesh = random_mesh(Kind::soup, 150, 2);
  for (std::size_t i = 0; i < 150; ++i) mesh.triangles.push_back(mesh.triangles[i]);
  for (std::size_t i = 0; i < 150; ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    mesh.triangles.emplace_back(t.x, t.z, t.y);
  }
  const Indexed of(scene_of(std::move(mesh)));
  for (const RayCamera& camera : cameras_at({0.1, 0.1, 0.1}, 4)) {
    EXPECT_GT(expect_as_ray_by_ray(of.index, camera), 0u);
    for (const PrimitiveId id : scan(of.index, camera).primitives) EXPECT_TRUE(id < 150 || id == no_primitive);
  }
}

TEST(ScanPackets, FindTheSameAtEveryScale) {
  for (const float scale : {1e-36f, 1e-30f, 1e-18f, 1e-9f, 1e9f, 1e15f, 1e25f, 1e37f}) {
    SCOPED_TRACE(scale);
    Mesh mesh = random_mesh(Kind::soup, 300, 6);
    for (glm::vec3& p : mesh.positions) p *= scale;
    const Indexed of(scene_of(std::move(mesh)));
    const glm::dvec3 eye = glm::dvec3(0.03, -0.1, 0.2) * double(scale);
    for (RayCamera camera : cameras_at(glm::dvec3(0), 8)) {
      camera.world_from_eye[3] = glm::dvec4(eye, 1);
      (void)expect_as_ray_by_ray(of.index, camera);
    }
    ASSERT_FALSE(HasFailure());
  }
}

/// Triangle sizes from a rounding error to a million units, in one scene.
TEST(ScanPackets, FindTheSameAmongAllSizes) {
  Random random(12);
  Mesh mesh;
  for (int i = 0; i < 900; ++i) {
    const float size = std::ldexp(1.0f, random.below(40) - 20);
    const glm::vec3 p = random.point(4 * size), q = p + random.point(size), r = p + random.point(size);
    add_triangle(mesh, p, q, r);
  }
  const Indexed of(scene_of(std::move(mesh)));
  std::size_t met = 0;
  for (const RayCamera& camera : cameras_at({1e-3, 2e-3, 0}, 8)) met += expect_as_ray_by_ray(of.index, camera);
  EXPECT_GT(met, 1000u);
}

}  // namespace
}  // namespace frontmost::test
