// SPDX-License-Identifier: Apache-2.0
// Edges that meshes state: drawn as creases, whatever their angle, and no other creases beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "frontmost/lines.h"
#include "support/meshes.h"
#include "support/tessellations.h"

namespace frontmost::test {
namespace {

/// A roof of two squares that meet along the y axis, each turned down by `slope` radians.
Mesh roof(double slope) {
  const float x = float(std::cos(slope)), z = -float(std::sin(slope));
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {x, 0, z}, {x, 1, z}, {-x, 0, z}, {-x, 1, z}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}};
  return mesh;
}

std::size_t creases_of(const Scene& scene, const LineOptions& options = {}) {
  const Surfaces surfaces(scene);
  const std::vector<DrawnEdge> edges =
      draw_lines(surfaces, frame(surfaces, 100, 100, {.forward = glm::dvec3(0.1, 0.2, -1)}), options).edges;
  return std::size_t(
      std::count_if(edges.begin(), edges.end(), [](const DrawnEdge& e) { return e.kind == EdgeKind::crease; }));
}

TEST(StatedEdges, AreCreasesWhateverTheirAngle) {
  Mesh flat = roof(0.01), steep = roof(0.5);
  EXPECT_EQ(creases_of(scene_of(flat)), 0u);
  EXPECT_EQ(creases_of(scene_of(steep)), 1u);
  flat.sharp_edges = {{1, 0}};
  steep.smooth_edges = {{0, 1}};
  EXPECT_EQ(creases_of(scene_of(flat)), 1u);
  EXPECT_EQ(creases_of(scene_of(steep)), 0u);
  // An angle that is asked for outweighs them, and without creases there are none.
  EXPECT_EQ(creases_of(scene_of(flat), {.crease_angle = 0.1}), 0u);
  EXPECT_EQ(creases_of(scene_of(steep), {.crease_angle = 0.1}), 1u);
  EXPECT_EQ(creases_of(scene_of(flat), {.creases = false}), 0u);
}

TEST(StatedEdges, ThatAreNoSidesSayNothing) {
  Mesh steep = roof(0.5);
  steep.sharp_edges = {{2, 5}};  // across the roof
  EXPECT_EQ(creases_of(scene_of(steep)), 1u);
  steep.positions.emplace_back(0, 0, 7);
  steep.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
  steep.sharp_edges = {{0, 6}, {0, 7}, {7, 7}, {0, 0}};
  EXPECT_EQ(creases_of(scene_of(steep)), 1u);
}

TEST(StatedEdges, BelongToTheirMeshAlone) {
  // Beside each other, one mesh states that its edge is smooth.
  Mesh silent = roof(0.5), stating = roof(0.5);
  stating.smooth_edges = {{0, 1}};
  Scene scene = scene_of(silent);
  add(scene, stating, glm::translate(glm::dmat4(1), {5, 0, 0}));
  EXPECT_EQ(creases_of(scene), 1u);
  // Copies of vertices at one place, as faces of CAD files have them.
  Mesh apart;
  for (const glm::uvec3& t : stating.triangles) {
    const auto first = std::uint32_t(apart.positions.size());
    for (int k = 0; k < 3; ++k) apart.positions.push_back(stating.positions[t[k]]);
    apart.triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_EQ(creases_of(scene_of(apart)), 1u);
  apart.smooth_edges = {{0, 5}};
  EXPECT_EQ(creases_of(scene_of(apart)), 0u);
}

TEST(StatedEdges, ShortOnesStay) {
  // A line of one crease that ends in the air is thought to be noise, unless it is stated.
  Mesh mesh;
  constexpr int n = 40;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const bool is_ridge = x == 20 && (y == 20 || y == 21);
      mesh.positions.emplace_back(x, y, is_ridge ? 0.35f : 0.0f);
    }
  const auto vertex = [](int x, int y) { return std::uint32_t(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      mesh.triangles.emplace_back(vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1));
      mesh.triangles.emplace_back(vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1));
    }
  mesh.sharp_edges = {{vertex(20, 20), vertex(20, 21)}};
  EXPECT_EQ(creases_of(scene_of(mesh)), 1u);
}

/// A disc of `sides` sides and radius 2 about (3, 4, 5), whose rim states its circle of a slightly different radius.
Mesh disc(std::uint32_t sides, double radius) {
  Mesh mesh;
  mesh.positions.emplace_back(3, 4, 5);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double height : {0.0, -1.0})
      mesh.positions.emplace_back(3 + 2 * std::cos(angle), 4 + 2 * std::sin(angle), 5 + height);
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t a = 1 + 2 * i, b = 1 + 2 * ((i + 1) % sides);
    mesh.triangles.emplace_back(0, a, b);
    mesh.triangles.emplace_back(a, a + 1, b + 1);
    mesh.triangles.emplace_back(a, b + 1, b);
    mesh.sharp_edges.emplace_back(a, b);
  }
  mesh.edge_circles = {{{3, 4, 5}, {0, 0, 1}, radius, 0, sides}};
  return mesh;
}

TEST(StatedEdges, CirclesHaveTheRadiusThatIsStated) {
  const Scene scene = scene_of(disc(40, 2.0000001));
  const Rounds rounds = find_rounds(Surfaces(scene));
  const auto circle = std::find_if(rounds.rounds.begin(), rounds.rounds.end(),
                                   [](const Round& round) { return round.kind == RoundKind::circle; });
  ASSERT_NE(circle, rounds.rounds.end());
  EXPECT_EQ(circle->radius, 2.0000001);
  EXPECT_EQ(circle->from, glm::dvec3(3, 4, 5));
  EXPECT_NEAR(circle->turn, 2 * std::numbers::pi, 1e-9);
}

TEST(StatedEdges, CirclesFollowTheirInstances) {
  Scene scene;
  const Mesh mesh = disc(40, 2);
  const glm::dmat4 turned =
      glm::rotate(glm::scale(glm::translate(glm::dmat4(1), {100, 0, 0}), glm::dvec3(3)), 0.5, glm::dvec3(1, 0, 0));
  add(scene, mesh, turned);
  add(scene, mesh, glm::scale(glm::dmat4(1), {1, 1, -1}));                             // mirrored
  add(scene, mesh, glm::translate(glm::scale(glm::dmat4(1), {1, 2, 1}), {0, 50, 0}));  // an ellipse
  const Rounds rounds = find_rounds(Surfaces(scene));
  for (const double radius : {2.0, 6.0})
    EXPECT_TRUE(std::any_of(rounds.rounds.begin(), rounds.rounds.end(), [&](const Round& round) {
      return round.kind == RoundKind::circle && std::abs(round.radius - radius) < 1e-12;
    })) << radius;
}

TEST(StatedEdges, SharpOnesAloneAreBesideThoseThatAnglesShow) {
  Mesh mesh = roof(0.5);
  mesh.sharp_edges = {{0, 2}};  // a boundary
  EXPECT_EQ(creases_of(scene_of(mesh)), 1u);
  mesh.smooth_edges = {{0, 3}};
  EXPECT_EQ(creases_of(scene_of(mesh)), 0u);
}

TEST(StatedEdges, GoOnWhereTrianglesWithoutAreaSplitThem) {
  // The filler 0-6-1 lies on the ridge of the roof, and the square on the left has its corner 6 there.
  Mesh mesh = roof(0.01);
  mesh.positions.emplace_back(0, 0.25, 0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {6, 1, 5}, {0, 6, 5}, {0, 5, 4}, {0, 1, 6}};
  mesh.sharp_edges = {{0, 1}};
  EXPECT_EQ(creases_of(scene_of(mesh)), 2u);
}

TEST(StatedEdges, ManyAtOneVertexTakeNoLonger) {
  // A fan: with a linear search at its hub, each of the spokes would look at all others.
  constexpr std::uint32_t sides = 100'000;
  Mesh mesh;
  mesh.positions.emplace_back(0, 0, 1);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % sides);
    mesh.sharp_edges.emplace_back(0, 1 + i);
  }
  mesh.edge_circles = {{{0, 0, 0}, {0, 0, 1}, 1, 0, sides}};  // which its spokes do not follow
  const Scene scene = scene_of(mesh);
  const Rounds rounds = find_rounds(Surfaces(scene));
  for (const Round& round : rounds.rounds) EXPECT_NE(round.radius, 1.5);
}

TEST(StatedEdges, CirclesThatTheirEdgesLeaveAreIgnored) {
  for (const double centre : {3.5, 1e300}) {
    Mesh mesh = disc(40, 2);
    mesh.edge_circles[0].centre.x = centre;
    const Scene scene = scene_of(mesh);
    const Rounds rounds = find_rounds(Surfaces(scene));
    for (const Round& round : rounds.rounds) EXPECT_NEAR(round.from.x, 3, 1e-3) << "found by its vertices";
  }
}

TEST(StatedEdges, CirclesOfWhichTwoEdgesAreCutAreKept) {
  // Six sides, of which the middle is 13 % inside the circle. A rim vertex i is number 1 + 2 i.
  const auto has_circle = [](std::initializer_list<std::uint32_t> cut, double share) {
    Mesh mesh = disc(6, 2);
    for (const std::uint32_t i : cut) {
      const glm::vec3 to = mesh.positions[1 + 2 * ((i + 1) % 6)];
      glm::vec3& from = mesh.positions[1 + 2 * i];
      from += (to - from) * float(share);
    }
    // Each rim vertex that moved ends the edge before it no longer.
    std::vector<glm::uvec2> edges;
    for (std::uint32_t i = 0; i < 6; ++i)
      if (std::find(cut.begin(), cut.end(), (i + 1) % 6) == cut.end()) edges.push_back(mesh.sharp_edges[i]);
    mesh.sharp_edges = edges;
    mesh.edge_circles[0].count = std::uint32_t(edges.size());
    const Scene scene = scene_of(mesh);
    const Rounds rounds = find_rounds(Surfaces(scene));
    return std::any_of(rounds.rounds.begin(), rounds.rounds.end(),
                       [](const Round& round) { return round.kind == RoundKind::circle && round.radius == 2; });
  };
  EXPECT_TRUE(has_circle({}, 0));
  EXPECT_TRUE(has_circle({0}, 0.5));
  EXPECT_TRUE(has_circle({0, 3}, 0.5));
  EXPECT_FALSE(has_circle({0, 2, 4}, 0.5)) << "no section leaves these";
  EXPECT_FALSE(has_circle({0}, -0.5)) << "outside";
}

TEST(StatedEdges, CirclesOfPolygonsInsideAreIgnored) {
  // A hexagon of the inner radius: all of its ends are as far inside as the middles of a circle's chords.
  const double inner = 2 * std::cos(std::numbers::pi / 6);
  Mesh mesh = disc(6, 2);
  for (glm::vec3& p : mesh.positions) p = glm::vec3(3 + (p.x - 3) * inner / 2, 4 + (p.y - 4) * inner / 2, p.z);
  const Scene scene = scene_of(mesh);
  for (const Round& round : find_rounds(Surfaces(scene)).rounds) EXPECT_NE(round.radius, 2);
}

TEST(StatedEdges, WrongOnesAreRefused) {
  const auto refuses = [](const auto& spoil) {
    Scene scene = scene_of(disc(40, 2));
    spoil(scene.meshes[0]);
    try {
      validate(scene);
      return std::string("valid");
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refuses([](Mesh&) {}), "valid");
  EXPECT_EQ(refuses([](Mesh& m) { m.sharp_edges[7].y = 1000; }),
            "test: mesh 0: edge 7: vertex 1000 is out of range, there are 81");
  EXPECT_EQ(refuses([](Mesh& m) {
              m.smooth_edges = {{1000, 0}};
            }),
            "test: mesh 0: edge 0: vertex 1000 is out of range, there are 81");
  for (const auto& spoil :
       {+[](Mesh& m) { m.edge_circles[0].first = 1; }, +[](Mesh& m) { m.edge_circles[0].first = 41; },
        +[](Mesh& m) { m.edge_circles[0].count = no_index; }})
    EXPECT_EQ(refuses(spoil), "test: mesh 0: circle 0 names edges that do not exist");
  EXPECT_EQ(refuses([](Mesh& m) { m.edge_circles.push_back(m.edge_circles[0]); }),
            "test: mesh 0: circle 1 names edges of an earlier circle");
  for (const auto& spoil :
       {+[](Mesh& m) { m.edge_circles[0].radius = 0; }, +[](Mesh& m) { m.edge_circles[0].radius = NAN; },
        +[](Mesh& m) {
          m.edge_circles[0].axis = {0, 0, 2};
        },
        +[](Mesh& m) { m.edge_circles[0].centre.x = INFINITY; }})
    EXPECT_EQ(refuses(spoil), "test: mesh 0: circle 0 has no place, no radius or no axis of unit length");
}

}  // namespace
}  // namespace frontmost::test
