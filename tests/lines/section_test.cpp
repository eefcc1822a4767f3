// SPDX-License-Identifier: Apache-2.0
// Sections of shapes with known cuts, of random shapes against the sum over their triangles, and of shapes that are not
// solid. The remaining solid is closed to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "frontmost/files.h"
#include "frontmost/lines.h"
#include "scene/shapes.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using std::numbers::pi;

Section cut_of(const Scene& scene, const CuttingPlane& plane) { return cut(Surfaces(scene), plane); }
Section cut_of(Mesh mesh, const CuttingPlane& plane) { return cut_of(scene_of(std::move(mesh)), plane); }

int axis_of(const CuttingPlane& plane) { return int(plane.towards) % 3; }
double sign_of(const CuttingPlane& plane) { return int(plane.towards) < 3 ? 1 : -1; }

glm::dvec3 corner_of(const Mesh& mesh, std::size_t triangle, int k) {
  return glm::dvec3(mesh.positions[mesh.triangles[triangle][k]]);
}

/// Vector along the triangle's normal whose length is twice the area.
glm::dvec3 normal_of(const Mesh& mesh, std::size_t triangle) {
  const glm::dvec3 a = corner_of(mesh, triangle, 0);
  return glm::cross(corner_of(mesh, triangle, 1) - a, corner_of(mesh, triangle, 2) - a);
}

double volume_of(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += glm::dot(corner_of(mesh, t, 0), glm::cross(corner_of(mesh, t, 1), corner_of(mesh, t, 2))) / 6;
  return sum;
}

/// Number of directed edges, compared to the bit, that do not occur as often in the opposite direction: 0 for a closed
/// mesh.
std::size_t open_sides(const Mesh& mesh) {
  using Key = std::array<float, 6>;
  std::map<Key, int> sides;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 &a = mesh.positions[t[k]], &b = mesh.positions[t[(k + 1) % 3]];
      ++sides[{a.x, a.y, a.z, b.x, b.y, b.z}];
      --sides[{b.x, b.y, b.z, a.x, a.y, a.z}];
    }
  return std::size_t(std::count_if(sides.begin(), sides.end(), [](const auto& side) { return side.second != 0; }));
}

/// Checks that a face's triangles lie in the plane, look towards the removed part, and cover the face's area.
void expect_filled(const Section& section, const CutFace& face, const CuttingPlane& plane) {
  const Mesh& mesh = section.scene.meshes[face.instance];
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.material_of(std::uint32_t(t)) != face.material) continue;
    for (int k = 0; k < 3; ++k) ASSERT_EQ(corner_of(mesh, t, k)[axis_of(plane)], float(plane.at));
    const double size = normal_of(mesh, t)[axis_of(plane)] * sign_of(plane);
    ASSERT_GE(size, 0);
    area += size / 2;
  }
  EXPECT_NEAR(area, face.area, 1e-9 * face.area);
  double around = 0;
  for (const std::vector<glm::vec3>& outline : face.outlines) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < outline.size(); ++i)
      sum += glm::cross(glm::dvec3(outline[i]), glm::dvec3(outline[(i + 1) % outline.size()]));
    around += sum[axis_of(plane)] * sign_of(plane) / 2;
  }
  EXPECT_NEAR(around, face.area, 1e-9 * face.area);
}

/// Cuts a closed shape. \returns its cut face.
CutFace expect_solid(const Mesh& mesh, const CuttingPlane& plane) {
  const Section section = cut_of(mesh, plane);
  EXPECT_EQ(section.faces.size(), 1u);
  if (section.faces.size() != 1) return {};
  EXPECT_EQ(section.faces[0].open_count, 0u);
  EXPECT_EQ(open_sides(section.scene.meshes[0]), 0u);
  expect_filled(section, section.faces[0], plane);
  return section.faces[0];
}

/// A prism over an outline from z = 0 to 1, with a fan of triangles at either end.
Mesh walls_over(const std::vector<glm::vec2>& outline) {
  Mesh mesh;
  const auto n = std::uint32_t(outline.size());
  for (const float z : {0.0f, 1.0f})
    for (const glm::vec2& p : outline) mesh.positions.emplace_back(p, z);
  for (const float z : {0.0f, 1.0f}) mesh.positions.emplace_back(0, 0, z);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(),
                          {{i, k, n + k}, {i, n + k, n + i}, {k, i, 2 * n}, {n + i, n + k, 2 * n + 1}});
  }
  return mesh;
}

/// A grid of quads on points, whose rows and columns close.
Mesh ring_mesh(int rows, int columns, const std::function<glm::dvec3(int, int)>& point) {
  Mesh mesh;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) mesh.positions.emplace_back(point(i, j));
  const auto at = [&](int i, int j) { return std::uint32_t((i % rows) * columns + j % columns); };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

Mesh torus(double ring, double tube, int around, int across) {
  return ring_mesh(around, across, [=](int i, int j) {
    const double a = 2 * pi * i / around, b = 2 * pi * j / across, r = ring + tube * std::cos(b);
    return glm::dvec3(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
  });
}

/// A tube about z with flat ends.
Mesh tube(double inner, double outer, double height, int sides) {
  return ring_mesh(sides, 4, [=](int i, int j) {
    const double a = 2 * pi * i / sides, r = j == 0 || j == 3 ? outer : inner;
    return glm::dvec3(r * std::cos(a), r * std::sin(a), j == 0 || j == 1 ? 0.0 : height);
  });
}

/// The mesh with nothing but positions and triangles.
Mesh bare(const Mesh& mesh) {
  Mesh other;
  other.positions = mesh.positions;
  other.triangles = mesh.triangles;
  return other;
}

Mesh outwards(Mesh mesh) {
  if (volume_of(mesh) < 0)
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

constexpr Axis all_axes[] = {Axis::x, Axis::y, Axis::z, Axis::minus_x, Axis::minus_y, Axis::minus_z};

TEST(Section, ACubeIsCutInASquareFromEverySide) {
  const Mesh cube = box({-1, -1, -1}, {1, 1, 1});
  for (const Axis axis : all_axes)
    for (const double at : {-0.75, 0.0, 0.5}) {
      const CutFace face = expect_solid(cube, {axis, at});
      EXPECT_EQ(face.area, 4);
      const double height = int(axis) < 3 ? at + 1 : 1 - at;
      EXPECT_NEAR(volume_of(cut_of(cube, {axis, at}).scene.meshes[0]), 4 * height, 1e-12);
    }
}

TEST(Section, TubesSpheresAndToriHaveTheAreasOfTheirFormulas) {
  // A polygon of n sides has n / 2 sin(2 pi / n) times the area of the square on its radius.
  const auto polygon = [](int n) { return n / 2.0 * std::sin(2 * pi / n); };
  const Mesh pipe = outwards(tube(3, 5, 10, 48));
  const CutFace across = expect_solid(pipe, {Axis::z, 4.3});
  EXPECT_EQ(across.outlines.size(), 2u);
  EXPECT_NEAR(across.area, polygon(48) * (25 - 9), 1e-4);
  const CutFace along = expect_solid(pipe, {Axis::minus_y, 0});
  EXPECT_EQ(along.outlines.size(), 2u);
  EXPECT_NEAR(along.area, 2 * 2 * 10, 1e-4);

  const Mesh ball = sphere(72);
  for (const double at : {-0.6, 0.0, 0.3})
    for (const Axis axis : all_axes) EXPECT_NEAR(expect_solid(ball, {axis, at}).area, pi * (1 - at * at), 5e-3);

  const Mesh ring = outwards(torus(10, 3, 180, 90));
  const CutFace level = expect_solid(ring, {Axis::z, 0});
  EXPECT_EQ(level.outlines.size(), 2u);
  EXPECT_NEAR(level.area, pi * (169 - 49), 0.2);
  const CutFace upright = expect_solid(ring, {Axis::x, 0});
  EXPECT_EQ(upright.outlines.size(), 2u);
  EXPECT_NEAR(upright.area, 2 * pi * 9, 0.1);
  // A plane through the hole cuts one outline around both sides; a plane that touches the hole's rim cuts two.
  EXPECT_EQ(expect_solid(ring, {Axis::x, 8.5}).outlines.size(), 1u);
}

TEST(Section, ThroughCornersEdgesAndFacesOfALatticeEveryCutIsClosed) {
  // The faces of the steps lie in the cutting planes.
  Mesh stairs;
  const auto add = [&](const Mesh& part) {
    const auto first = std::uint32_t(stairs.positions.size());
    stairs.positions.insert(stairs.positions.end(), part.positions.begin(), part.positions.end());
    for (const glm::uvec3& t : part.triangles) stairs.triangles.push_back(t + first);
  };
  for (int step = 0; step < 4; ++step) add(box({step, 0, 0}, {step + 1, 2, step + 1}));
  const Scene scene = scene_of(stairs);
  for (int at = 0; at < 6; ++at) {
    const Section section = cut_of(scene, {Axis::z, double(at)});
    // A step that ends at the plane is cut; a step that begins there is not.
    const double area = at == 0 ? 0 : std::max(0, 5 - at) * 2;
    EXPECT_EQ(section.faces.empty() ? 0 : section.faces[0].area, area) << at;
    EXPECT_EQ(open_sides(section.scene.meshes[0]), 0u);
    if (!section.faces.empty()) expect_filled(section, section.faces[0], {Axis::z, double(at)});
  }
  // Along the steps, the cuts are side by side.
  EXPECT_EQ(cut_of(scene, {Axis::y, 1}).faces[0].area, 1 + 2 + 3 + 4);
  EXPECT_EQ(cut_of(scene, {Axis::y, 1}).faces[0].outlines.size(), 4u);
  // A wall shared by two boxes occurs in both directions, and cancels out.
  stairs = {};
  for (int k = 0; k < 3; ++k) add(box({k, 0, 0}, {k + 1, 1, 1}));
  EXPECT_EQ(cut_of(stairs, {Axis::y, 0.5}).faces[0].area, 3);
  EXPECT_EQ(cut_of(stairs, {Axis::y, 0.5}).faces[0].outlines.size(), 1u);

  // An octahedron, cut through its vertices and edges.
  Mesh octahedron = sphere(2);
  for (const Axis axis : all_axes) EXPECT_EQ(expect_solid(octahedron, {axis, 0}).open_count, 0u);
}

TEST(Section, OutlinesThatCrossThemselvesAreClosedAllTheSame) {
  std::vector<std::vector<glm::vec2>> outlines = {
      {{-1, 0}, {2, 0}, {0, 1}, {0, -2}},                               // an hourglass whose two halves cancel
      {{-1, 0}, {2, 0}, {0, 1}, {0, -1}},                               // an hourglass whose halves do not cancel
      {{0, 0}, {9, 0}, {9, 0.01f}, {8.9f, -0.01f}, {8.9f, 5}, {0, 5}},  // a small loop at a vertex
      {},
      {}};
  for (int i = 0; i < 5; ++i)  // a pentagram, which winds around its middle twice
    outlines[3].emplace_back(std::cos(4 * pi * i / 5), std::sin(4 * pi * i / 5));
  Random random(7);
  for (int i = 0; i < 40; ++i) outlines[4].emplace_back(random.point(1));
  for (std::vector<glm::vec2>& outline : outlines) {
    if (volume_of(walls_over(outline)) < 0) std::reverse(outline.begin(), outline.end());
    for (const float at : {0.25f, 0.5f}) {
      const Section section = cut_of(walls_over(outline), {Axis::z, at});
      const Mesh& left = section.scene.meshes[0];
      EXPECT_EQ(open_sides(left), 0u) << outline.size();
      EXPECT_NEAR(volume_of(left), double(at) * volume_of(walls_over(outline)), 1e-5) << outline.size();
    }
  }
}

TEST(Section, RandomConvexSolidsBesideTheHullOfTheirEdges) {
  for (std::uint64_t seed = 0; seed < seeds(200); ++seed) {
    // A stretched, rotated and moved ball of few sides.
    Random random(seed);
    Mesh solid = sphere(2 + random.below(6));
    glm::mat3 turn(1);
    for (int k = 0; k < 3; ++k) turn[k] += random.point(0.6f);
    const glm::vec3 away = random.point(3);
    for (glm::vec3& p : solid.positions) p = turn * p + away;
    solid = outwards(std::move(solid));
    const Axis axis = all_axes[random.below(6)];
    const CuttingPlane plane{axis, double(away[int(axis) % 3]) + random.within(-0.4f, 0.4f)};
    const CutFace face = expect_solid(solid, plane);
    // Points where edges meet the plane, by angle about an inner point: the hull of a convex cut.
    const int across = axis_of(plane), u = (across + 1) % 3, v = (across + 2) % 3;
    std::vector<glm::dvec2> points;
    glm::dvec2 middle(0);
    for (const glm::uvec3& t : solid.triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 p(solid.positions[t[k]]), q(solid.positions[t[(k + 1) % 3]]);
        if ((p[across] < plane.at) == (q[across] < plane.at)) continue;
        const glm::dvec3 at = p + (q - p) * ((plane.at - p[across]) / (q[across] - p[across]));
        points.emplace_back(at[u], at[v]);
        middle += points.back();
      }
    middle /= double(points.size());
    const auto angle = [&](const glm::dvec2& p) { return std::atan2(p.y - middle.y, p.x - middle.x); };
    std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
    double area = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec2 a = points[i] - middle, b = points[(i + 1) % points.size()] - middle;
      area += (a.x * b.y - a.y * b.x) / 2;
    }
    EXPECT_NEAR(face.area, area, 1e-5 * area) << seed;
    EXPECT_EQ(face.outlines.size(), 1u) << seed;
  }
}

TEST(Section, CubesThatTouchInAnyPatternHaveAsManySquares) {
  for (std::uint64_t seed = 0; seed < seeds(100); ++seed) {
    // Cubes touch at vertices, edges and faces; common faces occur in both directions.
    constexpr int side = 4;
    Random random(seed);
    const int share = 2 + random.below(4);
    Mesh mesh;
    int layers[side] = {};
    for (int i = 0; i < side * side * side; ++i) {
      if (random.below(6) >= share) continue;
      const glm::ivec3 low(i % side, i / side % side, i / side / side);
      ++layers[low.z];
      const Mesh cube = box(glm::dvec3(low), glm::dvec3(low + 1));
      const auto first = std::uint32_t(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), cube.positions.begin(), cube.positions.end());
      for (const glm::uvec3& t : cube.triangles) mesh.triangles.push_back(t + first);
    }
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    for (const double at : {0.5, 1.0, 1.75, 2.0, 3.0, 4.0}) {
      // A cube that ends at the plane is cut; a cube that begins there is not.
      const int below = layers[int(std::ceil(at)) - 1];
      const Section section = cut(surfaces, {Axis::z, at});
      EXPECT_EQ(section.faces.empty() ? 0 : section.faces[0].area, below) << seed << " at " << at;
      if (section.faces.empty()) continue;
      EXPECT_EQ(section.faces[0].open_count, 0u);
      EXPECT_EQ(open_sides(section.scene.meshes[0]), 0u) << seed << " at " << at;
      expect_filled(section, section.faces[0], {Axis::z, at});
    }
  }
}

TEST(Section, HollowsAndIslandsInThemAreTold) {
  // From the outside: solid, hollow, solid, hollow. Every second sphere is turned inside out.
  Mesh all;
  for (int k = 0; k < 4; ++k) {
    Mesh ball = sphere(24);
    const auto first = std::uint32_t(all.positions.size());
    for (const glm::vec3& p : ball.positions) all.positions.push_back(p * float(4 - k));
    for (glm::uvec3 t : ball.triangles) {
      if (k % 2 == 1) std::swap(t.y, t.z);
      all.triangles.push_back(t + first);
    }
  }
  const CutFace face = expect_solid(all, {Axis::y, 0.1});
  EXPECT_EQ(face.outlines.size(), 4u);
  const double whole = expect_solid(sphere(24), {Axis::y, 0.025}).area;
  EXPECT_NEAR(face.area, whole * (16 - 9 + 4 - 1), 0.1);

  // Solids within solids: equal windings fill all; opposite windings go by odd and even.
  Mesh within = bare(box({-2, -2, -2}, {2, 2, 2}));
  const Mesh core = box({-1, -1, -1}, {1, 1, 1});
  const auto first = std::uint32_t(within.positions.size());
  within.positions.insert(within.positions.end(), core.positions.begin(), core.positions.end());
  for (const glm::uvec3& t : core.triangles) within.triangles.push_back(t + first);
  EXPECT_EQ(cut_of(within, {Axis::z, 0.5}).faces[0].area, 16);
  for (std::size_t t = 0; t < within.triangles.size(); t += 3) std::swap(within.triangles[t].y, within.triangles[t].z);
  EXPECT_EQ(cut_of(within, {Axis::z, 0.5}).faces[0].area, 12);
}

TEST(Section, EveryObjectHasItsOwnFace) {
  Scene scene;
  scene.meshes = {box({0, 0, 0}, {2, 2, 2}), sphere(16)};
  glm::dmat4 mirrored(1);
  mirrored[0][0] = -1;
  mirrored[3] = {5, 0, 1, 1};
  scene.instances = {{"box", 0, glm::dmat4(1)}, {"far", 1, glm::dmat4(1)}, {"mirrored", 0, mirrored}};
  scene.instances[1].world_from_mesh[3] = {0, 0, 50, 1};
  const CuttingPlane plane{Axis::z, 1.5};
  const Section section = cut_of(scene, plane);
  ASSERT_EQ(section.faces.size(), 2u);
  EXPECT_EQ(section.faces[0].instance, 0u);
  EXPECT_EQ(section.faces[1].instance, 2u);
  EXPECT_EQ(section.scene.materials[section.faces[1].material].name, "mirrored");
  ASSERT_EQ(section.scene.instances.size(), 3u);
  EXPECT_TRUE(section.scene.meshes[1].triangles.empty());  // it lay before the plane
  for (const CutFace& face : section.faces) {
    EXPECT_EQ(face.area, 4);
    EXPECT_EQ(open_sides(section.scene.meshes[face.instance]), 0u);
    EXPECT_GT(volume_of(section.scene.meshes[face.instance]), 0);  // mirrored objects are wound outwards too
  }
  validate(section.scene);
}

TEST(Section, WholeObjectsStayWholeWhereTheyAreMet) {
  Scene scene;
  scene.meshes = {box({0, 0, 0}, {2, 2, 2})};
  scene.meshes[0].sharp_edges = {{0, 1}};
  glm::dmat4 mirrored(1);
  mirrored[0][0] = -1;
  glm::dmat4 before(1);
  before[3] = {0, 0, 50, 1};
  scene.instances = {{"cut", 0, glm::dmat4(1)}, {"whole", 0, mirrored}, {"before", 0, before}};
  const std::uint32_t whole[] = {1, 2};
  const Section section = cut(Surfaces(scene), {Axis::z, 1.5}, {}, whole);
  ASSERT_EQ(section.faces.size(), 1u);
  EXPECT_EQ(section.faces[0].instance, 0u);
  const Mesh& kept = section.scene.meshes[1];
  EXPECT_NEAR(volume_of(kept), 8, 1e-6) << "turned outwards, although mirrored";
  EXPECT_EQ(open_sides(kept), 0u);
  EXPECT_EQ(kept.sharp_edges.size(), 1u);
  EXPECT_TRUE(section.scene.meshes[2].triangles.empty()) << "the plane does not meet it";
  validate(section.scene);
}

/// A prism of six sides over the unit circle, whose upright edges are seams and whose rims follow circles.
Mesh stated_prism() {
  constexpr std::uint32_t sides = 6;
  std::vector<glm::vec2> outline;
  for (std::uint32_t i = 0; i < sides; ++i)
    outline.emplace_back(std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides));
  Mesh mesh = walls_over(outline);
  for (const std::uint32_t first : {0u, sides}) {
    mesh.edge_circles.push_back({{0, 0, first == 0 ? 0 : 1}, {0, 0, 1}, 1, first, sides});
    for (std::uint32_t i = 0; i < sides; ++i) mesh.sharp_edges.emplace_back(first + i, first + (i + 1) % sides);
  }
  for (std::uint32_t i = 0; i < sides; ++i) mesh.smooth_edges.emplace_back(i, sides + i);
  return mesh;
}

/// Creases and silhouettes that lie level, without the cut face's own. Upright ones may be silhouettes, but not
/// creases.
std::size_t rim_edges(const Scene& scene, const CuttingPlane& plane) {
  const int across = axis_of(plane);
  const Surfaces surfaces(scene);
  std::size_t level = 0;
  for (const DrawnEdge& edge : draw_lines(surfaces, frame(surfaces, 100, 100)).edges) {
    const bool is_level = std::abs(edge.from.z - edge.to.z) < 1e-6, is_crease = edge.kind == EdgeKind::crease;
    EXPECT_FALSE(is_crease && !is_level);
    const bool is_of_face = edge.from[across] == plane.at && edge.to[across] == plane.at;
    level += is_level && !is_of_face && (is_crease || edge.kind == EdgeKind::silhouette);
  }
  return level;
}

TEST(Section, StatedEdgesAreCutWithTheirTriangles) {
  // Twice as large, mirrored, and moved. x = 0 becomes x = 5.
  Scene scene = scene_of(stated_prism());
  scene.instances[0].world_from_mesh = glm::dmat4({-2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {5, 6, 7, 1});
  const Section section = cut_of(scene, {Axis::x, 5});
  const Mesh& left = section.scene.meshes[0];
  validate(section.scene);
  EXPECT_EQ(left.sharp_edges.size(), 2u * 4) << "of six edges of a rim two are behind, and two are cut";
  ASSERT_EQ(left.edge_circles.size(), 2u);
  for (const EdgeCircle& circle : left.edge_circles) {
    EXPECT_EQ(circle.radius, 2);
    EXPECT_EQ(circle.count, 4u);
    EXPECT_EQ(circle.centre, glm::dvec3(5, 6, circle.first == 0 ? 7 : 9));
    EXPECT_EQ(circle.axis, glm::dvec3(0, 0, 1));
    double length = 0;
    for (std::uint32_t i = circle.first; i < circle.first + circle.count; ++i) {
      const glm::dvec3 from(left.positions[left.sharp_edges[i].x]), to(left.positions[left.sharp_edges[i].y]);
      EXPECT_LE(std::max(from.x, to.x), 5);
      length += glm::distance(from, to);
    }
    EXPECT_NEAR(length, 3 * 2, 1e-5) << "half of the rim";
  }
  // Sides of a hexagon meet at 60 degrees, but the file calls them smooth; rims are creases behind the plane.
  EXPECT_EQ(rim_edges(section.scene, {Axis::x, 5}), 2u * 4);
  const Rounds rounds = find_rounds(Surfaces(section.scene));
  EXPECT_EQ(std::count_if(rounds.rounds.begin(), rounds.rounds.end(),
                          [](const Round& round) { return round.kind == RoundKind::circle && round.radius == 2; }),
            2);
  // A plane that meets no seam, and one that leaves all.
  EXPECT_EQ(cut_of(scene, {Axis::z, 8}).scene.meshes[0].edge_circles.size(), 1u);
  EXPECT_EQ(rim_edges(cut_of(scene, {Axis::z, 8}).scene, {Axis::z, 8}), 6u);
  EXPECT_EQ(cut_of(scene, {Axis::z, 100}).scene.meshes[0].sharp_edges.size(), 12u);
  EXPECT_EQ(cut_of(scene, {Axis::z, 100}).scene.meshes[0].smooth_edges.size(), 6u);
  const std::uint32_t whole[] = {0};
  EXPECT_EQ(cut(Surfaces(scene), {Axis::x, 5}, {}, whole).scene.meshes[0].edge_circles.size(), 2u);
  // Circles become ellipses.
  scene.instances[0].world_from_mesh[0] *= 2;
  EXPECT_TRUE(cut_of(scene, {Axis::x, 5}).scene.meshes[0].edge_circles.empty());
  EXPECT_EQ(cut_of(scene, {Axis::x, 5}).scene.meshes[0].sharp_edges.size(), 8u);
}

TEST(Section, OpenMeshesAndBrokenNumbersAreNoSolids) {
  Mesh sheet;
  add_triangle(sheet, {-1, 0, -1}, {1, 0, -1}, {0, 0, 1});
  const Section cut_sheet = cut_of(sheet, {Axis::z, 0});
  ASSERT_EQ(cut_sheet.faces.size(), 1u);
  EXPECT_EQ(cut_sheet.faces[0].open_count, 1u);
  EXPECT_EQ(cut_sheet.faces[0].area, 0);
  EXPECT_TRUE(cut_sheet.faces[0].outlines.empty());

  Mesh cup = bare(box({0, 0, 0}, {1, 1, 1}));
  cup.triangles.erase(cup.triangles.begin());  // one side is open
  std::size_t open = 0;
  for (const Axis axis : all_axes) open += cut_of(cup, {axis, 0.25}).faces[0].open_count;
  EXPECT_EQ(open, 4u);

  // A vertex moved by a millionth leaves a crack, which is closed; moved by a tenth, one that stays open.
  for (const auto& [off, is_open] : {std::pair(1e-6f, false), std::pair(0.1f, true)}) {
    Mesh soup;
    const Mesh whole = sphere(8);
    for (const glm::uvec3& t : whole.triangles)
      add_triangle(soup, whole.positions[t.x], whole.positions[t.y], whole.positions[t.z]);
    soup.positions[std::size_t(3) * (whole.triangles.size() / 2 + 5)].x += off;
    const CutFace face = cut_of(soup, {Axis::y, -0.08}).faces[0];
    EXPECT_EQ(face.open_count > 0, is_open) << off;
    EXPECT_EQ(face.outlines.size(), is_open ? 0u : 1u) << off;
  }

  EXPECT_TRUE(cut_of(sheet, {Axis::z, 7}).faces.empty());
  EXPECT_TRUE(cut_of(sheet, {Axis::z, -7}).faces.empty());
  EXPECT_TRUE(cut_of(sheet, {Axis::z, -7}).scene.meshes[0].triangles.empty());
  EXPECT_TRUE(cut_of(Scene(), {}).faces.empty());
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300})
    EXPECT_THROW((void)cut_of(sheet, {Axis::z, bad}), Error);
  Mesh broken = box({0, 0, 0}, {1, 1, 1});
  broken.positions[0].x = std::nanf("");
  EXPECT_NO_THROW((void)cut_of(broken, {Axis::x, 0.5}));
}

TEST(Section, WhateverIsCutIsFilledInThePlane) {
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const RandomCase random = random_case(kind, seed);
      const CuttingPlane plane{all_axes[seed % 6], 0.125 * double(seed % 3)};
      const Section section = cut_of(random.scene, plane);
      for (const CutFace& face : section.faces) {
        const Mesh& mesh = section.scene.meshes[face.instance];
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
          if (mesh.material_of(std::uint32_t(t)) != face.material) continue;
          ASSERT_GE(normal_of(mesh, t)[axis_of(plane)] * sign_of(plane), 0);
        }
      }
      for (const glm::uvec3& t : section.scene.meshes[0].triangles)
        for (int k = 0; k < 3; ++k) {
          const double height = section.scene.meshes[0].positions[t[k]][axis_of(plane)] - plane.at;
          ASSERT_LE(height * sign_of(plane), 0);
        }
    }
}

TEST(Section, ADrawingShowsTheOutlineAndNoLineWithinIt) {
  const Scene scene = scene_of(outwards(tube(3, 5, 10, 48)));
  const Section section = cut_of(scene, {Axis::minus_y, 0});
  const Surfaces surfaces(section.scene);
  FrameOptions options;
  options.orthographic = true;
  options.forward = {0, 1, 0};
  options.up = {0, 0, 1};
  const Drawing drawing = draw_lines(surfaces, frame(surfaces, 1000, 1000, options));
  const Strokes all = chain_strokes(surfaces, drawing, {.with_hidden = false, .by_kind = false, .by_outline = false});
  const double pixel =
      glm::distance(drawing.parts[0].from, drawing.parts[0].to) /
      glm::distance(drawing.edges[drawing.parts[0].edge].from, drawing.edges[drawing.parts[0].edge].to);
  double length = 0;
  for (const Stroke& stroke : all.strokes)
    for (std::uint32_t i = 0; i + 1 < stroke.count + std::uint32_t(stroke.is_closed); ++i)
      length += glm::distance(all.points[stroke.first + i], all.points[stroke.first + (i + 1) % stroke.count]);
  // The section shows two rectangles of 2 by 10, and the ends of the bore between them.
  EXPECT_NEAR(length / std::max(pixel, 1e-9), 2 * 24 + 2 * 6, 0.5);
}

TEST(Section, HatchingLiesOnCutFacesThatAreSeen) {
  Scene scene;
  scene.meshes = {box({0, 0, 0}, {4, 4, 4}), box({4, 0, 0}, {6, 4, 4}), box({0, 0, 6}, {4, 4, 8})};
  for (std::uint32_t i = 0; i < 3; ++i) scene.instances.push_back({std::to_string(i), i, glm::dmat4(1)});
  const CuttingPlane plane{Axis::minus_y, 2};
  const Section section = cut_of(scene, plane);
  const Surfaces surfaces(section.scene);
  FrameOptions front;
  front.orthographic = true;
  front.forward = {0, 1, 0};
  front.up = {0, 0, 1};
  const View view = frame(surfaces, 800, 800, front);
  HatchOptions options;
  options.sets = section_hatch_sets(section, hatch_styles(std::array{&section}), {.spacing = 10});
  options.tone = section_tone(plane);
  const std::vector<HatchLine> lines = hatch(surfaces, view, options);
  const double pixels = view.width / (view.projection.right - view.projection.left);
  double length[3] = {};
  glm::dvec2 direction[3];
  for (const HatchLine& line : lines) {
    ASSERT_LT(line.instance, 3u);
    length[line.instance] += glm::distance(line.from, line.to);
    direction[line.instance] = glm::normalize(line.to - line.from);
  }
  // Length times spacing is the area. The first two objects touch, so their angles differ; the third is apart.
  EXPECT_NEAR(length[0] * 10, 16 * pixels * pixels, 0.02 * 16 * pixels * pixels);
  EXPECT_NEAR(length[1] * 10, 8 * pixels * pixels, 0.03 * 8 * pixels * pixels);
  EXPECT_NEAR(std::abs(glm::dot(direction[0], direction[1])), 0, 1e-6);
  EXPECT_NEAR(std::abs(glm::dot(direction[0], direction[2])), 1, 1e-6);
  for (const glm::dvec2& d : direction) EXPECT_NEAR(std::abs(d.x), std::abs(d.y), 1e-6);
  // From behind, nothing of the cut is visible, and thin parts are solid.
  front.forward = {0, -1, 0};
  EXPECT_TRUE(hatch(surfaces, frame(surfaces, 800, 800, front), options).empty());
  const std::vector<HatchSet> solid = section_hatch_sets(section, hatch_styles(std::array{&section}),
                                                         {.spacing = 10, .solid_spacing = 1, .thinnest = 1.6});
  EXPECT_EQ(std::count_if(solid.begin(), solid.end(), [](const HatchSet& s) { return s.spacing == 1; }), 1);
}

TEST(Section, CadModelsAreClosedWhereverTheyAreCut) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t cuts = 0, open = 0;
  for (const char* const name : {"cad/angle-block.stl", "cad/as1.stl", "cad/crank-arm.stl", "cad/featuretype.stl",
                                 "cad/linkrod.glb", "cad/two-cylinders.stl", "cad/torus.stl"}) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    const Box box = surfaces.bounds();
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 1; i < 8; ++i) {
        const CuttingPlane plane{Axis(axis), box.low[axis] + (box.high[axis] - box.low[axis]) * i / 8.0};
        const Section section = cut(surfaces, plane);
        for (const CutFace& face : section.faces) {
          ++cuts;
          open += face.open_count;
          expect_filled(section, face, plane);
        }
      }
  }
  EXPECT_GT(cuts, 100u);
  EXPECT_EQ(open, 0u);
}

}  // namespace
}  // namespace frontmost::test
