// SPDX-License-Identifier: Apache-2.0
// Triangles that occur more than once: shared by objects or repeated within one, with other vertex orders, and
// mirrored.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "frontmost/lines.h"
#include "lines/mesh/feature_edges.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

View view_of_all() {
  View view;
  view.width = view.height = 200;
  view.world_from_eye = look_at({3, 4, 9}, glm::dvec3(0), glm::dvec3(0, 1, 0));
  view.projection = make_projection(0.6, 1, {0.5, 50});
  return view;
}

/// A plate of n x n squares with edges of 1/4 around the origin; `is_rising` chooses the diagonals. The middle square
/// is cut the same way in any case.
Mesh plate(int n, bool is_rising) {
  Mesh mesh;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y) {
      const auto at = [&](int i, int j) {
        return glm::vec3(0.25f * float(x + i) - 0.125f * float(n), 0.25f * float(y + j) - 0.125f * float(n), 0);
      };
      const bool is_middle = x == n / 2 && y == n / 2;
      if (is_rising || is_middle)
        add_quad(mesh, at(0, 0), at(1, 0), at(1, 1), at(0, 1));
      else
        add_quad(mesh, at(1, 0), at(1, 1), at(0, 1), at(0, 0));
    }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

/// Rotates the vertex order of each triangle, and reverses every other triangle.
Mesh turned(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    glm::uvec3& t = mesh.triangles[i];
    for (std::size_t k = 0; k < i % 3; ++k) t = {t.y, t.z, t.x};
    if (i % 2 == 0) std::swap(t.y, t.z);
  }
  return mesh;
}

Scene scene_of_objects(const std::vector<Mesh>& meshes) {
  Scene scene;
  for (const Mesh& mesh : meshes) {
    scene.meshes.push_back(mesh);
    scene.instances.push_back({"object", std::uint32_t(scene.meshes.size() - 1), glm::dmat4(1.0)});
  }
  return scene;
}

std::size_t edge_count(const Scene& scene, const LineOptions& options = {}) {
  return draw_lines(Surfaces(scene), view_of_all(), options).edges.size();
}

/// Only the edges of the rim remain: 4 n.
TEST(SharedTriangles, LeaveNoEdgesBetweenTwoPlates) {
  const Mesh one = plate(5, true), other = plate(5, false);
  EXPECT_EQ(edge_count(scene_of_objects({one})), 20u);
  EXPECT_EQ(edge_count(scene_of_objects({one, other})), 20u);
  EXPECT_EQ(edge_count(scene_of_objects({other, one, turned(one), turned(other), one})), 20u);
}

TEST(SharedTriangles, MayBeMirroredCopies) {
  Scene scene = scene_of_objects({plate(5, true), plate(5, false)});
  // The plate's mirror image has the other diagonals, except in the middle square.
  scene.instances.push_back({"mirrored", 0, glm::scale(glm::dmat4(1.0), {-1, 1, 1})});
  scene.instances.push_back({"turned", 1, glm::scale(glm::dmat4(1.0), {-1, -1, 1})});
  EXPECT_EQ(edge_count(scene), 20u);
}

/// The middle square of plate(5, ...) with a triangle on each edge, up to tips that no plate has.
Mesh patch() {
  Mesh mesh;
  const float r = 0.125f, far = 0.22f;
  const glm::vec3 a(-r, -r, 0), b(r, -r, 0), c(r, r, 0), d(-r, r, 0);
  add_quad(mesh, a, b, c, d);
  add_triangle(mesh, b, a, {0.01f, -far, 0});
  add_triangle(mesh, c, b, {far, 0.02f, 0});
  add_triangle(mesh, d, c, {0.03f, far, 0});
  add_triangle(mesh, a, d, {-far, 0.04f, 0});
  return mesh;
}

TEST(SharedTriangles, MayBeOfOneObject) {
  Mesh both = plate(5, true);
  const Mesh over = patch();
  append(both, over);
  EXPECT_EQ(edge_count(scene_of(both)), 20u + 8u);
  EXPECT_EQ(edge_count(scene_of(turned(both))), 20u + 8u);
  EXPECT_EQ(edge_count(scene_of_objects({plate(5, true), over})), 20u + 8u);
  append(both, turned(both));
  EXPECT_EQ(edge_count(scene_of(both)), 20u + 8u);
  EXPECT_EQ(edge_count(scene_of_objects({both, plate(5, true), turned(both)})), 20u + 8u);
}

/// A box, and a wedge on one half of its top. They share a triangle of the top, and each has an edge of its own.
TEST(SharedTriangles, KeepTheCreasesOfEachObject) {
  const glm::vec3 a(-1, 0, -1), b(1, 0, -1), c(1, 0, 1), d(-1, 0, 1), down(0, -1, 0), top(0.8f, 1, -0.8f);
  Mesh box, wedge;
  add_quad(box, a, d, c, b);  // cut from a to c
  add_quad(box, a + down, b + down, c + down, d + down);
  add_quad(box, a, b, b + down, a + down);
  add_quad(box, b, c, c + down, b + down);
  add_quad(box, c, d, d + down, c + down);
  add_quad(box, d, a, a + down, d + down);
  add_triangle(wedge, a, b, c);
  add_triangle(wedge, b, a, top);
  add_triangle(wedge, c, b, top);
  add_triangle(wedge, a, c, top);
  LineOptions options;
  options.intersections = false;
  for (const bool is_turned : {false, true}) {
    const Scene scene = scene_of_objects({box, is_turned ? turned(wedge) : wedge});
    const Drawing drawing = draw_lines(Surfaces(scene), view_of_all(), options);
    EXPECT_EQ(drawing.edges.size(), 12u + 4u);
    for (const DrawnEdge& edge : drawing.edges) EXPECT_NE(edge.kind, EdgeKind::boundary);
  }
}

TEST(SharedTriangles, LeaveOpenWhatIsOpen) {
  // Three triangles around an edge, each given twice, and a fourth that shares nothing.
  Mesh fans;
  const glm::vec3 low(0, -1, 0), high(0, 1, 0);
  for (const glm::vec3& tip : {glm::vec3(1, 0, 0), glm::vec3(-1, 0.1f, 0.1f), glm::vec3(0.1f, 0.2f, 1)})
    add_triangle(fans, low, high, tip);
  const auto edge_kind = [&](const Scene& scene) {
    for (const DrawnEdge& edge : draw_lines(Surfaces(scene), view_of_all()).edges)
      if (edge.from.x == 0 && edge.to.x == 0) return edge.kind;
    return EdgeKind::intersection;
  };
  EXPECT_EQ(edge_kind(scene_of(fans)), EdgeKind::boundary);
  EXPECT_EQ(edge_kind(scene_of_objects({fans, turned(fans)})), EdgeKind::boundary);
}

lines_detail::Side side(std::uint32_t triangle, std::uint32_t opposite) { return {1, triangle, opposite, true}; }

TEST(PairedSides, PairCopiesOfOneMaterial) {
  using namespace lines_detail;
  // Triangles 0 and 1 at vertex 5 have materials 0 and 1; their neighbours have one each.
  const std::vector<Side> sides = {side(0, 5), side(1, 5), side(2, 6), side(3, 7)};
  const auto pairs = paired_sides(sides, [](std::uint32_t triangle) {
    return SurfaceOf{0, triangle == 1 || triangle == 2};
  });
  ASSERT_TRUE(pairs);
  ASSERT_EQ(pairs->size(), 2u);
  EXPECT_EQ((*pairs)[0].first.triangle, 1u);
  EXPECT_EQ((*pairs)[0].second.triangle, 2u);
  EXPECT_EQ((*pairs)[1].first.triangle, 0u);
  EXPECT_EQ((*pairs)[1].second.triangle, 3u);
}

TEST(PairedSides, OfTwoCommonSidesNoneCanBeTold) {
  using namespace lines_detail;
  const std::vector<Side> sides = {side(0, 5), side(1, 5), side(2, 6), side(3, 6), side(4, 7), side(5, 8)};
  EXPECT_FALSE(paired_sides(sides, [](std::uint32_t) { return SurfaceOf{0, 0}; }));
  // The objects have 5 and 6, 5 and 7, and 6 and 8.
  const std::uint32_t instances[] = {0, 1, 0, 2, 1, 2};
  const auto pairs = paired_sides(sides, [&](std::uint32_t triangle) { return SurfaceOf{instances[triangle], 0}; });
  ASSERT_TRUE(pairs);
  EXPECT_EQ(pairs->size(), 3u);
}

}  // namespace
}  // namespace frontmost::test
