// SPDX-License-Identifier: Apache-2.0
// Surfaces that intersect exactly along edges and diagonals: the line is drawn once.
#include <gtest/gtest.h>

#include "support/crossings.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

/// A box whose faces have one diagonal or, if `turned`, the other.
Mesh box(const glm::vec3& low, const glm::vec3& high, bool turned) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {low[axis], high[axis]}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto at = [&](float at_u, float at_v) {
        glm::vec3 p;
        p[axis] = side;
        p[u] = at_u;
        p[v] = at_v;
        return p;
      };
      const glm::vec3 a = at(low[u], low[v]), b = at(high[u], low[v]), c = at(high[u], high[v]),
                      d = at(low[u], high[v]);
      if (turned)
        add_quad(mesh, b, c, d, a);
      else
        add_quad(mesh, a, b, c, d);
    }
  return mesh;
}

Mesh joined_meshes(Mesh a, const Mesh& b) {
  for (const glm::uvec3& t : b.triangles) add_triangle(a, b.positions[t.x], b.positions[t.y], b.positions[t.z]);
  return a;
}

/// Total length of all intersection segments; no two of them overlap.
double crossing_length(const Mesh& mesh) {
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  double length = 0;
  const Drawing drawing = draw_lines(surfaces, frame(surfaces, 100, 100), {.crease_angle = 0.1});
  for (const DrawnEdge& edge : drawing.edges) {
    const glm::dvec3 along = edge.to - edge.from;
    // No segment lies along a drawn edge either.
    for (const DrawnEdge& other : drawing.edges) {
      if (&other == &edge || edge.kind != EdgeKind::intersection) continue;
      const auto place = [&](const glm::dvec3& p) { return glm::dot(p - edge.from, along) / glm::dot(along, along); };
      const auto off = [&](const glm::dvec3& p) { return glm::length(p - edge.from - along * place(p)); };
      if (off(other.from) > 1e-9 || off(other.to) > 1e-9) continue;
      const double a = place(other.from), b = place(other.to);
      EXPECT_FALSE(std::min(a, b) < 1 - 1e-9 && std::max(a, b) > 1e-9);
    }
    if (edge.kind == EdgeKind::intersection) length += glm::length(along);
  }
  return length;
}

const double root_2 = std::sqrt(2.0);

TEST(EdgeContacts, ASheetAlongADiagonal) {
  Mesh flat;
  add_quad(flat, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  Mesh through = flat;
  add_quad(through, {-1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, -1, 1});
  EXPECT_NEAR(crossing_length(through), 2 * root_2, 1e-12);
  Mesh beyond = flat;  // one triangle that reaches farther than the diagonal
  add_triangle(beyond, {-3, -3, -1}, {3, 3, -1}, {0, 0, 3});
  EXPECT_NEAR(crossing_length(beyond), 2 * root_2, 1e-12);
  Mesh within = flat;  // and one that ends within
  add_triangle(within, {-0.5f, -0.5f, -1}, {0.5f, 0.5f, -1}, {0, 0, 1});
  EXPECT_NEAR(crossing_length(within), root_2 / 2, 1e-12);
  Mesh standing = flat;
  add_quad(standing, {-1, -1, 0}, {1, 1, 0}, {1, 1, 1}, {-1, -1, 1});
  EXPECT_EQ(crossing_length(standing), 0);
}

TEST(EdgeContacts, EdgesAlongEachOther) {
  Mesh mesh;
  add_quad(mesh, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  Mesh through = mesh;  // two quads: one stands on the diagonal, the other hangs from it
  add_quad(through, {-2, -2, 0}, {2, 2, 0}, {2, 2, 1}, {-2, -2, 1});
  add_quad(through, {-2, -2, 0}, {2, 2, 0}, {2, 2, -1}, {-2, -2, -1});
  EXPECT_NEAR(crossing_length(through), 2 * root_2, 1e-12);
  Mesh folded = mesh;  // both on one side: they touch
  add_quad(folded, {-2, -2, 0}, {2, 2, 0}, {2, 2, 1}, {-2, -2, 1});
  add_quad(folded, {-2, -2, 0}, {2, 2, 0}, {2, 2.5f, 1}, {-2, -1.5f, 1});
  EXPECT_EQ(crossing_length(folded), 0);
}

TEST(EdgeContacts, APlaneThroughTheCornersOfACube) {
  for (const bool turned : {false, true})
    for (const bool flipped : {false, true}) {
      Mesh mesh = box(glm::vec3(-1), glm::vec3(1), turned);
      const float s = flipped ? -1.0f : 1.0f;
      add_quad(mesh, {-2 * s, -2, -2}, {2 * s, 2, -2}, {2 * s, 2, 2}, {-2 * s, -2, 2});
      // The diagonals above and below are lines; the upright edges are drawn anyway.
      EXPECT_NEAR(crossing_length(mesh), 4 * root_2, 1e-12) << turned << flipped;
    }
}

TEST(EdgeContacts, BeamsThroughEachOther) {
  for (const bool turned : {false, true}) {
    const Mesh beam = box({-3, -1, -1}, {3, 1, 1}, turned);
    // A beam level above and below: they intersect in the four upright lines.
    EXPECT_NEAR(crossing_length(joined_meshes(beam, box({-1, -3, -1}, {1, 3, 1}, !turned))), 8, 1e-12);
    EXPECT_NEAR(crossing_length(joined_meshes(beam, box({-1, -3, -1}, {1, 3, 1}, turned))), 8, 1e-12);
    // A beam through one side and out at the other: two squares.
    EXPECT_NEAR(crossing_length(joined_meshes(beam, box({-0.5f, -3, -0.5f}, {0.5f, 3, 0.5f}, turned))), 8, 1e-12);
    // The edges of the diamond, turned by 45 degrees, lie in the middle of the beam's sides: each side's middle line.
    Mesh diamond;
    const glm::vec2 corners[4] = {{2, 0}, {0, 2}, {-2, 0}, {0, -2}};
    for (int k = 0; k < 4; ++k) {
      const glm::vec2 p = corners[k], q = corners[(k + 1) % 4];
      add_quad(diamond, {-4, p.x, p.y}, {4, p.x, p.y}, {4, q.x, q.y}, {-4, q.x, q.y});
    }
    // The inscribed beam's edges touch the diamond's sides from within.
    EXPECT_EQ(crossing_length(joined_meshes(beam, diamond)), 0);
  }
}

/// Two pairs of triangles, each on an edge: one triangle of a pair lies on the ground, the other stands on it. A common
/// line on the ground must lie along both edges.
TEST(EdgeContacts, OnOnePlaneLieAlongBothEdges) {
  Random random(9);
  const auto on_ground = [&] {
    const auto x = float(random.below(4));
    const auto y = float(random.below(4));
    return glm::vec3(x, y, 0);
  };
  std::size_t found = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Mesh mesh;
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 a = on_ground();
      const glm::vec3 b = on_ground();
      const glm::vec3 c = on_ground();
      add_triangle(mesh, a, b, c);
      add_triangle(mesh, b, a, {40 * side, 2, 20});
    }
    const auto is_along = [&](std::size_t edge, const glm::dvec3& p) {
      const glm::dvec3 a = mesh.positions[6 * edge], b = mesh.positions[6 * edge + 1];
      return (b.x - a.x) * (p.y - a.y) == (b.y - a.y) * (p.x - a.x);
    };
    const Scene scene = scene_of(mesh);
    for (const Crossing& c : crossings_of(weld(Surfaces(scene), {}), {}, {})) {
      if (c.from.place.z != 0 || c.to.place.z != 0) continue;
      ++found;
      for (const std::size_t edge : {0u, 1u})
        EXPECT_TRUE(is_along(edge, c.from.place) && is_along(edge, c.to.place)) << trial;
    }
  }
  EXPECT_GT(found, 2u);
}

TEST(EdgeContacts, OrderOfTrianglesAndCornersDoesNotMatter) {
  Random random(4);
  Mesh mesh = box(glm::vec3(-1), glm::vec3(1), false);
  add_quad(mesh, {-2, -2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, -2, 2});
  for (int trial = 0; trial < 20; ++trial) {
    for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i)
      std::swap(mesh.triangles[i], mesh.triangles[std::size_t(random.below(int(i) + 1))]);
    for (glm::uvec3& t : mesh.triangles) t = {t.y, t.z, t.x};
    EXPECT_NEAR(crossing_length(mesh), 4 * root_2, 1e-12);
  }
}

TEST(EdgeContacts, StretchesOfAFoldAreNone) {
  // Segments of a fold lie in the planes of triangles further along it; one of the fold's own triangles is among these.
  const glm::vec3 top(-1, 1, 0), bottom(-2, 0.25f, 1.5f), ends[2] = {{-2, 0.5f, 1}, {-1, 1, 1}};
  const std::vector<glm::vec3> fold = {
      ends[0], {-1.375f, 0.8125f, 1}, {-1.25f, 0.875f, 1}, {-1.125f, 0.9375f, 1}, ends[1]};
  Mesh mesh;
  add_triangle(mesh, {-1.25f, 0.75f, 0}, ends[0], top);
  for (std::size_t i = 0; i + 1 < fold.size(); ++i) add_triangle(mesh, top, fold[i], fold[i + 1]);
  for (std::size_t i = fold.size() - 1; i > 0; --i) add_triangle(mesh, fold[i], fold[i - 1], bottom);
  const Scene scene = scene_of(mesh);
  EXPECT_TRUE(crossings_of(weld(Surfaces(scene), {}), {}, {}).empty());
}

}  // namespace
}  // namespace frontmost::test
