// SPDX-License-Identifier: Apache-2.0
// Creases of shapes with known creases, whatever their tessellation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "frontmost/lines.h"
#include "support/tessellations.h"

namespace frontmost::test {
namespace {

/// All edges that do not depend on the view.
std::vector<DrawnEdge> creases_of(const Scene& scene, std::optional<double> angle = std::nullopt) {
  LineOptions options;
  options.crease_angle = angle;
  options.silhouettes = options.intersections = false;
  return draw_lines(Surfaces(scene), frame(Surfaces(scene), 100, 100), options).edges;
}
std::vector<DrawnEdge> creases_of(const Mesh& mesh, std::optional<double> angle = std::nullopt) {
  return creases_of(scene_of(mesh), angle);
}

double length_of(const std::vector<DrawnEdge>& edges) {
  double sum = 0;
  for (const DrawnEdge& edge : edges) sum += glm::distance(edge.from, edge.to);
  return sum;
}

std::size_t count_at_height(const std::vector<DrawnEdge>& edges, double z) {
  return std::size_t(std::count_if(edges.begin(), edges.end(), [&](const DrawnEdge& edge) {
    return std::abs(edge.from.z - z) < 1e-5 && std::abs(edge.to.z - z) < 1e-5;
  }));
}

/// A hexagon nut without its bore, 13 across flats and 8 high, with a chamfer of `chamfer` degrees around its top.
Mesh nut(int sides, double chamfer) {
  const double inner = 6.2, slope = std::tan(chamfer * kDegree);
  const auto hexagon = [](double angle) {
    const double sector = std::numbers::pi / 3, within = std::fmod(angle + 1e-9, sector) - sector / 2;
    return 6.5 / std::cos(within);
  };
  const std::vector<ProfilePoint> rings = {
      at(0, 0), [=](double angle) { return glm::dvec2(hexagon(angle), 0); },
      [=](double angle) { return glm::dvec2(hexagon(angle), 8 - (hexagon(angle) - inner) * slope); }, at(inner, 8)};
  const std::vector<double> angles = even_angles(sides);
  Mesh mesh;
  add_sides(mesh, rings, angles);
  add_lid(mesh, rings.back(), angles, true);
  return mesh;
}

TEST(Creases, AChamferOf30DegreesIsDrawnAllAround) {
  for (const int sides : {24, 30, 36, 48, 72, 96, 192}) {
    SCOPED_TRACE(sides);
    const std::vector<DrawnEdge> edges = creases_of(nut(sides, 30));
    EXPECT_EQ(count_at_height(edges, 8), std::size_t(sides));
    EXPECT_EQ(count_at_height(edges, 0), std::size_t(sides));
    EXPECT_EQ(edges.size(), std::size_t(3 * sides + 6));
    // A given angle takes precedence.
    EXPECT_LT(count_at_height(creases_of(nut(sides, 30), 31 * kDegree), 8), 1u);
  }
}

TEST(Creases, FlatConesHaveARim) {
  for (const int sides : {16, 24, 48, 100})
    for (const double slope : {20.0, 25.0, 29.0, 60.0}) {
      SCOPED_TRACE(sides);
      SCOPED_TRACE(slope);
      Mesh mesh;
      add_sides(mesh, {at(6, -4), at(6, 0), at(0, 6 * std::tan(slope * kDegree))}, even_angles(sides));
      add_lid(mesh, at(6, -4), even_angles(sides), false);
      const std::vector<DrawnEdge> edges = creases_of(mesh);
      // At a slope of 60 degrees the rim has a fold of 30 degrees.
      EXPECT_EQ(count_at_height(edges, 0), std::size_t(sides));
      EXPECT_EQ(edges.size(), std::size_t(2 * sides));
    }
}

TEST(Creases, CylindersOfElevenSidesAndMoreAreRound) {
  for (int sides = 11; sides < 64; ++sides) {
    SCOPED_TRACE(sides);
    const std::vector<ProfilePoint> rings = {at(5, 0), at(5, 3), at(5, 4), at(5, 20)};
    Mesh mesh;
    add_sides(mesh, rings, even_angles(sides));
    EXPECT_EQ(creases_of(mesh).size(), std::size_t(2 * sides));  // its open ends
    add_lid(mesh, rings.front(), even_angles(sides), false);
    add_lid(mesh, rings.back(), even_angles(sides), true);
    EXPECT_EQ(creases_of(mesh).size(), std::size_t(2 * sides));
    Scene copies = scene_of(mesh);
    copies.instances.push_back(copies.instances[0]);
    EXPECT_EQ(creases_of(copies).size(), std::size_t(2 * sides));
  }
}

TEST(Creases, CylindersOfTenSidesAreNot) {
  Mesh mesh;
  add_sides(mesh, {at(5, 0), at(5, 20)}, even_angles(10));
  EXPECT_EQ(creases_of(mesh).size(), 30u);
}

TEST(Creases, UnevenSegmentsAreRound) {
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (const int sides : {20, 28, 50}) {
      SCOPED_TRACE(seed);
      Mesh mesh;
      add_sides(mesh, {at(5, 0), at(5, 20)}, uneven_angles(sides, 3, seed));
      EXPECT_EQ(creases_of(mesh).size(), std::size_t(2 * sides)) << sides;
    }
}

TEST(Creases, FilletsRunIntoPlanesWithoutALine) {
  // A disc whose rim is rounded in `steps` of up to 28 degrees, as coarse as CAD programs tessellate.
  for (int steps = 4; steps < 20; ++steps) {
    SCOPED_TRACE(steps);
    std::vector<ProfilePoint> rings = {at(12, 0)};
    for (int i = 0; i <= steps; ++i) {
      const double angle = std::numbers::pi / 2 * i / steps;
      rings.push_back(at(10 + 2 * std::cos(angle), 6 + 2 * std::sin(angle)));
    }
    Mesh mesh;
    add_sides(mesh, rings, even_angles(40));
    add_lid(mesh, rings.back(), even_angles(40), true);
    EXPECT_EQ(creases_of(mesh).size(), 40u);  // the open end
  }
}

/// A wall on two arcs, the first to the right and the second to the left, in steps of `step`. Where they meet, the wall
/// turns by `fold`.
Mesh two_arcs(double step, double fold) {
  constexpr int steps = 6;
  std::vector<glm::vec2> line = {{0, 0}};
  double heading = 0;
  for (int i = 0; i < 2 * steps; ++i) {
    line.push_back(line.back() + glm::vec2(std::cos(heading), std::sin(heading)));
    heading += i + 1 == steps ? fold : i + 1 < steps ? -step : step;
  }
  Mesh mesh;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const glm::vec3 a(line[i], 0), b(line[i + 1], 0), c(line[i + 1], 7), d(line[i], 7);
    add_triangle(mesh, a, b, i % 2 == 0 ? c : d);
    add_triangle(mesh, i % 2 == 0 ? a : b, c, d);
  }
  return mesh;
}

TEST(Creases, ACylinderAndAFilletThatMeetAtAFewDegreesHaveALine) {
  // The open wall has 12 edges below and above, and one at each end.
  for (const double step : {1.0, 3.0, 5.0, 6.0})
    for (const double fold : {17.0, 19.0, 25.0}) {
      SCOPED_TRACE(step);
      EXPECT_EQ(creases_of(two_arcs(step * kDegree, fold * kDegree)).size(), 27u) << fold;
    }
  // Two arcs of the same kind that join without a fold have no crease.
  for (const double step : {6.0, 10.0, 16.0})
    EXPECT_EQ(creases_of(two_arcs(step * kDegree, -step * kDegree)).size(), 26u) << step;
}

TEST(Creases, SpheresAreRound) {
  for (const int sides : {16, 24, 60}) {
    std::vector<ProfilePoint> rings;
    for (int i = 0; i <= sides / 2; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      rings.push_back(at(i % (sides / 2) == 0 ? 0 : 3 * std::sin(angle), -3 * std::cos(angle)));
    }
    Mesh mesh;
    add_sides(mesh, rings, even_angles(sides));
    EXPECT_TRUE(creases_of(mesh).empty()) << sides;
  }
}

/// A cylinder whose lid has an additional vertex on the circle between every two of the side's `sides` vertices.
/// Slivers in the plane of the lid fill the gap to the side. With `is_fine`, there are three vertices, and slivers on
/// slivers.
Mesh cylinder_with_slivers(int sides, bool is_fine) {
  const int parts = is_fine ? 4 : 2;
  const std::vector<double> fine = even_angles(sides * parts), coarse = even_angles(sides);
  Mesh mesh;
  add_sides(mesh, {at(5, 0), at(5, 20)}, coarse);
  // The lower lid ends at the coarse vertices; at the top, slivers fill the gap to the circle.
  add_lid(mesh, at(5, 0), coarse, false);
  for (int i = 0; i < sides * parts; i += parts)
    for (int k = 0; k + 1 < parts; ++k) {
      const auto p = [&](int number) { return turned_about_z(at(5, 20), fine[std::size_t(number % (sides * parts))]); };
      add_triangle(mesh, p(i), p(i + k + 1), p(i + k + 2));
    }
  add_sides(mesh, {at(5, 20), at(0, 20)}, fine);
  return mesh;
}

TEST(Creases, SliversDoNotDoubleARim) {
  for (const int sides : {24, 40, 90})
    for (const bool is_fine : {false, true}) {
      SCOPED_TRACE(sides);
      const std::vector<DrawnEdge> edges = creases_of(cylinder_with_slivers(sides, is_fine));
      const double circle = 2 * std::numbers::pi * 5;
      EXPECT_NEAR(length_of(edges), 2 * circle, 0.02 * circle);
    }
}

/// A smooth wall like a bottle's. Some triangle edges have a vertex in the middle, moved out onto the true surface by a
/// tenth of the sagitta, so that a sliver stands on each.
Mesh wall_with_slivers(int sides) {
  const std::vector<double> angles = even_angles(sides);
  Mesh mesh;
  Random random(3);
  for (int row = 0; row < 8; ++row)
    for (int k = 0; k < sides; ++k) {
      const double from = angles[std::size_t(k)], to = angles[std::size_t((k + 1) % sides)];
      const double low = row * 1.5, high = low + 1.5;
      const glm::vec3 a = turned_about_z(at(5, low), from), b = turned_about_z(at(5, low), to),
                      c = turned_about_z(at(5, high), to), d = turned_about_z(at(5, high), from);
      add_triangle(mesh, a, c, d);
      if (row == 0 || random.below(3) > 0) {
        add_triangle(mesh, a, b, c);
        continue;
      }
      // The lower triangle has a whole edge, the upper one a vertex on it: the sliver between them may have any normal.
      const double middle = from + std::fmod(to - from + 2 * std::numbers::pi, 2 * std::numbers::pi) / 2;
      const glm::vec3 m = turned_about_z(at(5, low + 0.002), middle);
      add_triangle(mesh, a, b, m);
      add_triangle(mesh, a, m, c);
      add_triangle(mesh, m, b, c);
    }
  return mesh;
}

TEST(Creases, SliversDrawNoTicksOnSmoothWalls) {
  for (const int sides : {20, 36, 60, 120}) {
    const std::vector<DrawnEdge> edges = creases_of(wall_with_slivers(sides));
    EXPECT_EQ(edges.size(), std::size_t(2 * sides)) << sides;  // its open ends
    EXPECT_GT(creases_of(wall_with_slivers(sides), 30 * kDegree).size(), std::size_t(3 * sides)) << "a test of nothing";
  }
}

std::size_t count_along_ridge(const std::vector<DrawnEdge>& edges, double reach) {
  return std::size_t(std::count_if(edges.begin(), edges.end(), [&](const DrawnEdge& edge) {
    return edge.kind == EdgeKind::crease && std::abs(edge.from.x - 0.5) < reach && std::abs(edge.to.x - 0.5) < reach;
  }));
}

TEST(Creases, OfARoughCastingAreUnbroken) {
  // A roof of 60 degrees whose faces are as rough as a cast: no angle alone distinguishes its ridge.
  const auto roof = [](float x) { return 0.577f * (0.5f - std::abs(x - 0.5f)); };
  const int n = 40;
  const Mesh mesh = bent(n, 0.09f, roof);
  const std::vector<DrawnEdge> edges = creases_of(mesh);
  const std::size_t on_ridge = count_along_ridge(edges, 0.2 / n);
  EXPECT_EQ(on_ridge, std::size_t(n));
  EXPECT_EQ(edges.size(), std::size_t(4 * n) + on_ridge);
}

TEST(Creases, OfARoughPlateThereAreNone) {
  for (const float noise : {0.01f, 0.05f, 0.09f}) {
    const std::vector<DrawnEdge> edges = creases_of(bent(40, noise, [](float) { return 0.0f; }));
    EXPECT_EQ(edges.size(), 160u) << noise;
  }
}

/// A cube of n x n squares a face, its vertices moved by rounding or a little more.
Mesh noisy_cube(int n, float noise) {
  Mesh mesh;
  const auto moved = [&](const glm::ivec3& corner) {
    Random random(std::uint64_t(corner.x * 10007 + corner.y * 101 + corner.z));
    const glm::vec3 by = random.point(noise);
    return glm::vec3(corner) / float(n) + by;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int u = 0; u < n; ++u)
        for (int v = 0; v < n; ++v) {
          const auto corner = [&](int i, int k) {
            glm::ivec3 at(0);
            at[axis] = side, at[(axis + 1) % 3] = u + i, at[(axis + 2) % 3] = v + k;
            return moved(at);
          };
          add_triangle(mesh, corner(0, 0), corner(1, 0), corner(1, 1));
          add_triangle(mesh, corner(0, 0), corner(1, 1), corner(0, 1));
        }
  return mesh;
}

/// For every line without sharp bends that ends in the air at both ends: its number of edges and its length.
std::vector<std::pair<std::size_t, double>> lone_lines_of(const std::vector<DrawnEdge>& edges) {
  using Place = std::array<double, 3>;
  const auto place = [](const glm::dvec3& p) { return Place{p.x, p.y, p.z}; };
  std::map<Place, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const glm::dvec3& end : {edges[i].from, edges[i].to}) at[place(end)].push_back(i);
  std::vector<std::pair<std::size_t, double>> lines;
  for (const auto& [tip, beside] : at) {
    if (beside.size() != 1) continue;
    std::size_t edge = beside[0], count = 0;
    double length = 0;
    glm::dvec3 before(0);
    for (Place here = tip;;) {
      glm::dvec3 from = edges[edge].from, to = edges[edge].to;
      if (place(from) != here) std::swap(from, to);
      const glm::dvec3 along = glm::normalize(to - from);
      if (count > 0 && glm::dot(before, along) < 0.25) break;
      before = along;
      here = place(to);
      length += glm::distance(from, to);
      ++count;
      const std::vector<std::size_t>& next = at[here];
      if (next.size() == 1) lines.emplace_back(count, length);
      if (next.size() != 2) break;
      edge = next[0] == edge ? next[1] : next[0];
    }
  }
  return lines;
}

TEST(Creases, ThatEndInTheAirAtBothEndsAreLong) {
  std::size_t count = 0;
  for (const float noise : {0.12f, 0.16f, 0.2f}) {
    const std::vector<DrawnEdge> edges = creases_of(bent(100, noise, [](float) { return 0.0f; }));
    count += edges.size() - 400;  // the plate's sides
    for (const auto& [edge_count, length] : lone_lines_of(edges))
      EXPECT_TRUE(edge_count >= 10 || length > 0.05 * std::sqrt(2.0)) << noise << ' ' << edge_count << ' ' << length;
  }
  EXPECT_GT(count, 100u) << "a test of nothing";
}

TEST(Creases, OfANoisyBoxAreItsTwelveEdges) {
  for (const float noise : {0.0f, 1e-7f, 1e-5f, 1e-3f, 5e-3f})
    EXPECT_EQ(creases_of(noisy_cube(8, noise)).size(), 12u * 8u) << noise;
}

TEST(Creases, ThreadsAndInstructionSetsChangeNothing) {
  const Scene scene = scene_of(bent(60, 0.2f, [](float x) { return 0.3f * std::sin(20 * x); }));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 240);
  const Drawing one = draw_lines(surfaces, view, {}, {.threads = 1});
  for (const Execution& execution : {Execution{.threads = 4}, Execution{.threads = 1, .isa = Isa::scalar}}) {
    const Drawing other = draw_lines(surfaces, view, {}, execution);
    ASSERT_EQ(one.edges.size(), other.edges.size());
    for (std::size_t i = 0; i < one.edges.size(); ++i) {
      EXPECT_EQ(one.edges[i].from, other.edges[i].from);
      EXPECT_EQ(one.edges[i].to, other.edges[i].to);
      EXPECT_EQ(one.edges[i].kind, other.edges[i].kind);
    }
  }
}

TEST(Creases, HardlyDependOnTheView) {
  const Scene scene = scene_of(nut(48, 30));
  const Surfaces surfaces(scene);
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Drawing drawing = draw_lines(surfaces, random_view(random, 100, 100));
    // The drawing has the nut's own edges, and beyond these only silhouettes.
    std::size_t creases = 0;
    for (const DrawnEdge& edge : drawing.edges) creases += edge.kind == EdgeKind::crease;
    EXPECT_LE(creases, 3u * 48u + 6u);
    EXPECT_GE(drawing.edges.size(), 3u * 48u + 6u);
  }
}

}  // namespace
}  // namespace frontmost::test
