// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "frontmost/report.h"
#include "scene/compose.h"
#include "scene/shapes.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({"object", 0, glm::dmat4(1.0)});
  return scene;
}

MeshReport inspect_mesh(const Mesh& mesh, int threads = 0) {
  return inspect(scene_of(mesh), {.threads = threads}).meshes[0];
}

// A copy where every corner has its own vertex, as STL stores it.
Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = std::uint32_t(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.positions[t[k]]);
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

void append(Mesh& mesh, const Mesh& other, const glm::vec3& by = glm::vec3(0)) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::vec3& p : other.positions) mesh.positions.push_back(p + by);
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

Mesh bare(const Mesh& mesh) {
  Mesh result;
  append(result, mesh);
  return result;
}

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

TEST(Inspect, AClosedMeshHasNothingOdd) {
  for (const Mesh& mesh : {tetrahedron(), soup(tetrahedron())}) {
    const MeshReport report = inspect_mesh(mesh);
    EXPECT_FALSE(report.odd.any());
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.pieces, 1u);
    EXPECT_EQ(report.positions, 4u);
    EXPECT_EQ(report.genus, 0u);
  }
}

TEST(Inspect, PositiveAndNegativeZeroAreOnePlace) {
  Mesh mesh = soup(tetrahedron());
  for (std::size_t i = 0; i < mesh.positions.size(); i += 2)
    for (int k = 0; k < 3; ++k)
      if (mesh.positions[i][k] == 0) mesh.positions[i][k] = -0.0f;
  EXPECT_FALSE(inspect_mesh(mesh).odd.any());
}

TEST(Inspect, CountsTheEdgesOfAHole) {
  Mesh mesh = soup(tetrahedron());
  mesh.triangles.pop_back();
  const MeshReport report = inspect_mesh(mesh);
  EXPECT_EQ(report.odd, (Oddities{.boundary_edges = 3}));
  EXPECT_FALSE(report.closed);
  EXPECT_FALSE(report.genus);
  EXPECT_EQ(report.positions, 4u);
}

TEST(Inspect, ATurnedTriangleIsInconsistentOnItsThreeEdges) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[2].x, mesh.triangles[2].y);
  const MeshReport report = inspect_mesh(mesh);
  EXPECT_EQ(report.odd, (Oddities{.inconsistent_edges = 3}));
  EXPECT_TRUE(report.closed);
  EXPECT_FALSE(report.genus);
}

TEST(Inspect, ThreeTrianglesAtAnEdgeAreNonManifold) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  EXPECT_EQ(inspect_mesh(mesh).odd, (Oddities{.boundary_edges = 6, .non_manifold_edges = 1}));
}

TEST(Inspect, FindsDuplicatesInAnyRotationAndOrder) {
  Mesh mesh = soup(tetrahedron());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.triangles.emplace_back(a, b, c); };
  add(1, 2, 0);
  add(2, 1, 0);
  add(5, 3, 4);
  const MeshReport report = inspect_mesh(mesh);
  EXPECT_EQ(report.odd.duplicate_triangles, 3u);
  EXPECT_EQ(report.odd.non_manifold_edges, 5u) << "the edges of two faces, one of them common";
}

TEST(Inspect, DegenerateTrianglesAreCountedAndOnlyThoseWithThreeCornersHaveEdges) {
  Mesh mesh = tetrahedron();
  mesh.triangles.emplace_back(1, 1, 2);  // repeated number
  mesh.positions.emplace_back(1, 0, 0);  // repeated position
  mesh.triangles.emplace_back(1, 4, 2);
  EXPECT_EQ(inspect_mesh(mesh).odd.degenerate_triangles, 2u);
  EXPECT_EQ(inspect_mesh(mesh).odd.boundary_edges, 0u);
  mesh.positions.insert(mesh.positions.end(), {{5, 5, 5}, {6, 6, 6}, {8, 8, 8}});  // on a line
  mesh.triangles.emplace_back(5, 6, 7);
  EXPECT_EQ(inspect_mesh(mesh).odd.degenerate_triangles, 3u);
  EXPECT_EQ(inspect_mesh(mesh).odd.boundary_edges, 3u);
}

TEST(Inspect, NonFiniteTrianglesAreCountedAndLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Mesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {{nan, 0, 0}, {0, -inf, 0}, {1e30f, 0, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {5, 1, 2}, {4, 4, 4}});
  const SceneReport report = inspect(scene_of(mesh));
  EXPECT_EQ(report.odd, (Oddities{.non_finite_triangles = 3}));
  EXPECT_TRUE(report.meshes[0].closed);
  EXPECT_EQ(report.bounds.low, glm::vec3(0));
  EXPECT_EQ(report.bounds.high, glm::vec3(1)) << "vertices that no triangle uses do not count";
}

TEST(Inspect, CountsPiecesOverCornersAndShellsOverEdges) {
  Mesh mesh;
  append(mesh, bare(box({0, 0, 0}, {1, 1, 1})));
  append(mesh, bare(box({1, 1, 1}, {2, 2, 2})));  // touches the first in a vertex
  append(mesh, tetrahedron(), {5, 5, 5});
  for (const Mesh& m : {mesh, soup(mesh)}) {
    const MeshReport report = inspect_mesh(m);
    EXPECT_EQ(report.pieces, 2u);
    EXPECT_EQ(report.shells, 3u);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.positions, 15u + 4u);
    EXPECT_EQ(report.genus, 0u) << "the common corner is no handle";
  }
}

TEST(Inspect, MeasuresAreaAndVolumeInTheWorld) {
  Scene scene;
  Mesh hollow = bare(box({10, 10, 10}, {13, 13, 13}));  // with a cavity of 1, inside out
  Mesh inner = bare(box({11, 11, 11}, {12, 12, 12}));
  for (glm::uvec3& triangle : inner.triangles) std::swap(triangle.y, triangle.z);
  append(hollow, inner);
  scene.meshes = {hollow, tetrahedron()};
  scene.meshes[1].triangles.pop_back();
  glm::dmat4 place(1.0);
  place[0].x = -2;  // mirrored, twice as long along x
  place[3] = {1e7, 0, 0, 1};
  scene.instances = {{"hollow", 0, glm::dmat4(1.0)}, {"long", 0, place}, {"open", 1, glm::dmat4(1.0)}};
  const SceneReport report = inspect(scene);
  EXPECT_NEAR(report.objects[0].area, 60, 1e-9);
  EXPECT_NEAR(report.objects[0].volume.value(), 26, 1e-9);
  EXPECT_NEAR(report.objects[1].area, 20 + 2 * 40, 1e-6);
  EXPECT_NEAR(report.objects[1].volume.value(), 52, 1e-6);
  EXPECT_FALSE(report.objects[2].volume);
  EXPECT_NEAR(report.volume.value(), 78, 1e-6);
  EXPECT_NEAR(report.area, 160 + report.objects[2].area, 1e-6);
}

TEST(Inspect, GenusIsTheNumberOfHandles) {
  EXPECT_EQ(inspect_mesh(sphere(9)).genus, 0u);
  EXPECT_EQ(inspect_mesh(torus_knot({})).genus, 1u);
  Mesh two = bare(torus_knot({}));
  append(two, torus_knot({}), {10, 0, 0});
  append(two, sphere(5), {20, 0, 0});
  EXPECT_EQ(inspect_mesh(soup(two)).genus, 2u);
  EXPECT_EQ(inspect_mesh(soup(two)).pieces, 3u);
}

TEST(Inspect, TheTeapotIsFourPiecesWithSixRims) {
  const SceneReport report = inspect(builtin("teapot"));
  EXPECT_EQ(report.triangles, 6320u);
  EXPECT_EQ(report.odd, (Oddities{.boundary_edges = 160}));
  EXPECT_EQ(report.meshes[0].shells, 4u);
  EXPECT_EQ(report.meshes[0].pieces, 3u) << "the handle touches the body in one point";
  EXPECT_EQ(report.bounds.low.y, 0);
  EXPECT_EQ(report.bounds.high.y, 3.15f);
}

// Reference answers by maps and sets, over small random soups with all defects at once.
MeshReport plain_report(const Mesh& mesh) {
  using Point = std::array<float, 3>;
  MeshReport report;
  std::map<std::pair<Point, Point>, std::vector<std::pair<std::size_t, bool>>> edges;
  std::set<std::array<Point, 3>> seen;
  std::vector<std::size_t> piece(mesh.triangles.size());
  std::set<std::size_t> with_edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 v = mesh.positions[mesh.triangles[t][int(k)]];
      p[k] = {v.x, v.y, v.z};
    }
    piece[t] = t;
    const glm::vec3 a(p[0][0], p[0][1], p[0][2]), b(p[1][0], p[1][1], p[1][2]), c(p[2][0], p[2][1], p[2][2]);
    report.odd.degenerate_triangles += glm::cross(b - a, c - a) == glm::vec3(0);  // exact on small integers
    std::array<Point, 3> sorted = p;
    std::sort(sorted.begin(), sorted.end());
    report.odd.duplicate_triangles += !seen.insert(sorted).second;
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) continue;
    with_edges.insert(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &from = p[k], &to = p[(k + 1) % 3];
      edges[std::minmax(from, to)].emplace_back(t, from < to);
    }
  }
  for (const auto& [ends, uses] : edges) {
    report.odd.boundary_edges += uses.size() == 1;
    report.odd.non_manifold_edges += uses.size() > 2;
    report.odd.inconsistent_edges += uses.size() == 2 && uses[0].second == uses[1].second;
    for (const auto& use : uses) {
      const std::size_t from = piece[use.first], to = piece[uses[0].first];
      for (std::size_t& p : piece)
        if (p == from) p = to;
    }
  }
  std::set<std::size_t> shells;
  for (const std::size_t t : with_edges) shells.insert(piece[t]);
  report.shells = shells.size();
  return report;
}

TEST(Inspect, AgreesWithThePlainWayOnRandomSoups) {
  std::mt19937 random(test::noted_seed(4));
  Oddities all;
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t side = 2 + std::uint32_t(random()) % 3;
    Mesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i)
      mesh.positions.emplace_back(random() % side, random() % side, random() % side);
    const std::uint32_t triangles = 1 + std::uint32_t(random()) % 40;
    for (std::uint32_t t = 0; t < triangles; ++t)
      mesh.triangles.emplace_back(random() % 60, random() % 60, random() % 60);
    const MeshReport expected = plain_report(mesh), report = inspect_mesh(mesh, 1 + round % 3);
    ASSERT_EQ(report.odd, expected.odd) << "round " << round;
    ASSERT_EQ(report.shells, expected.shells) << "round " << round;
    all.non_manifold_edges += report.odd.non_manifold_edges;
    all.inconsistent_edges += report.odd.inconsistent_edges;
    all.duplicate_triangles += report.odd.duplicate_triangles;
  }
  EXPECT_GT(std::min({all.non_manifold_edges, all.inconsistent_edges, all.duplicate_triangles}), 100u);
}

TEST(Inspect, DoesNotDependOnThreadsOrOnTheOrderOfTriangles) {
  Mesh mesh = bare(torus_knot({.along = 2000, .around = 40}));
  std::mt19937 random(test::noted_seed(5));
  for (int i = 0; i < 3000; ++i) std::swap(mesh.triangles[random() % 160000].x, mesh.triangles[random() % 160000].z);
  const MeshReport first = inspect_mesh(mesh, 1);
  EXPECT_GT(first.odd.boundary_edges, 1000u);
  for (const int threads : {2, 5}) EXPECT_EQ(inspect_mesh(mesh, threads).odd, first.odd);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  const MeshReport shuffled = inspect_mesh(soup(mesh), 2);
  EXPECT_EQ(shuffled.odd, first.odd);
  EXPECT_EQ(shuffled.pieces, first.pieces);
  EXPECT_EQ(shuffled.shells, first.shells);
  EXPECT_EQ(shuffled.positions, first.positions);
}

TEST(Inspect, SumsOverInstancesAndMeshes) {
  Scene scene = builtin("cubes");
  scene.instances.push_back({"third", 1, moved({100, 0, 0})});
  scene.meshes.push_back({});  // stored, but without an instance
  scene.meshes.back().name = "loose";
  scene.meshes.back().positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.meshes.back().triangles = {{0, 1, 2}};
  const SceneReport report = inspect(scene);
  EXPECT_EQ(report.triangles, 36u);
  EXPECT_EQ(report.stored_triangles, 25u);
  EXPECT_EQ(report.vertices, 19u);
  EXPECT_EQ(report.odd, (Oddities{.boundary_edges = 3}));
  ASSERT_EQ(report.objects.size(), 3u);
  EXPECT_EQ(report.objects[2].name, "third");
  EXPECT_EQ(report.objects[2].bounds.low, glm::vec3(99, -1, -1));
  EXPECT_EQ(report.bounds.high.x, 101);
  EXPECT_EQ(report.objects[0].bounds.low, glm::vec3(-1.5f, 0, -0.75f));
  ASSERT_EQ(report.materials.size(), 2u);
  EXPECT_EQ(report.materials[0].triangles, 12u);
  EXPECT_EQ(report.materials[1].triangles, 24u);
  EXPECT_EQ(report.meshes[0].faces, 6u);
  EXPECT_EQ(report.meshes[2].materials[0].material, no_index);
}

TEST(Inspect, CountsMaterialsPerTriangle) {
  Scene scene = scene_of(tetrahedron());
  scene.materials.resize(3);
  scene.meshes[0].material_ids = {2, no_index, 2, 0};
  for (const std::size_t materials : {3, 50}) {  // counted, and sorted if there are more materials than triangles
    scene.materials.resize(materials);
    const SceneReport report = inspect(scene);
    const auto& uses = report.meshes[0].materials;
    ASSERT_EQ(uses.size(), 3u);
    EXPECT_EQ(uses[0].material, 0u);
    EXPECT_EQ(uses[1].material, 2u);
    EXPECT_EQ(uses[1].triangles, 2u);
    EXPECT_EQ(uses[2].material, no_index);
    EXPECT_EQ(report.materials[2].triangles, 2u);
  }
}

TEST(Inspect, CamerasComeInWorldTerms) {
  Scene scene;
  scene.cameras.push_back(camera_at("front", {0, 0, 7}, {0, 0, 0}, 90));
  const SceneReport report = inspect(scene);
  EXPECT_EQ(report.cameras[0].position, glm::dvec3(0, 0, 7));
  EXPECT_EQ(report.cameras[0].direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(report.cameras[0].up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(report.cameras[0].vertical, scene.cameras[0].vertical);
  EXPECT_NEAR(report.cameras[0].vertical, 1.5707963267948966, 1e-12);
  EXPECT_TRUE(report.bounds.is_empty());
}

TEST(Inspect, MaterialsSayHowTheyAreSeen) {
  Scene scene = scene_of(tetrahedron());
  scene.materials.resize(2);
  scene.materials[1].name = "leaf";
  scene.materials[1].double_sided = true;
  scene.materials[1].alpha = Material::Alpha::mask;
  const SceneReport report = inspect(scene);
  EXPECT_FALSE(report.materials[0].double_sided);
  EXPECT_EQ(report.materials[1].name, "leaf");
  EXPECT_TRUE(report.materials[1].double_sided);
  EXPECT_EQ(report.materials[1].alpha, Material::Alpha::mask);
}

TEST(Inspect, BoundsLeaveOutWhatInstancesCarryBeyondFloats) {
  Scene scene = scene_of(tetrahedron());
  scene.meshes[0].positions[0] = {3e38f, 0, 0};  // finite, and twice as much is not
  const glm::vec3 high = inspect(scene).bounds.high;
  scene.instances[0].world_from_mesh = glm::dmat4(2);
  const Box bounds = inspect(scene).bounds;
  EXPECT_EQ(high.x, 3e38f);
  EXPECT_LT(bounds.high.x, 10);
  EXPECT_FALSE(bounds.is_empty());
}

TEST(Inspect, SurvivesAbsurdTransforms) {
  Scene scene = scene_of(tetrahedron());
  scene.instances[0].world_from_mesh = glm::dmat4(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(inspect(scene).bounds.is_empty());
  scene.instances[0].world_from_mesh = scaled(1e300);
  EXPECT_TRUE(inspect(scene).objects[0].bounds.low == glm::vec3(0)) << "what overflows is left out";
}

TEST(Inspect, BadIndicesAreAnErrorNotACrash) {
  Scene scene = scene_of(tetrahedron());
  scene.meshes[0].triangles.emplace_back(0, 1, 99);
  EXPECT_THROW((void)inspect(scene), Error);
}

TEST(LikelyUnits, AreThoseInWhichAPartIsAsLargeAsPartsAre) {
  const auto of = [](float size) { return likely_units({glm::vec3(0), glm::vec3(0, size, size / 2)}); };
  using Units = std::vector<double>;
  for (const float size : {5.0f, 120.0f, 2000.0f}) EXPECT_EQ(of(size), Units({0.001})) << size;
  for (const float size : {0.002f, 0.125f, 0.96875f}) EXPECT_EQ(of(size), Units({1})) << size;
  for (const float size : {1.0f, 2.5f, 4.75f}) EXPECT_EQ(of(size), Units({0.01, 0.0254, 1})) << size;
  for (const float size : {0.0f, 0.0005f, 2048.0f, 1e30f}) EXPECT_EQ(of(size), Units()) << size;
  EXPECT_EQ(likely_units({glm::vec3(-3e38f), glm::vec3(3e38f)}), Units());
  EXPECT_EQ(likely_units({}), Units());
}

TEST(Inspect, CanBeCancelled) {
  const Watch watch{.progress = {}, .cancelled = [] { return true; }};
  EXPECT_THROW((void)inspect(scene_of(torus_knot({})), {.watch = &watch}), Error);
}

}  // namespace
}  // namespace frontmost
