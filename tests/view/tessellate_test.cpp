// SPDX-License-Identifier: Apache-2.0
// Tessellation for a view: distance from the surface on the screen, and edges without cracks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "scene/bezier_patch.h"
#include "scene/shapes.h"
#include "view/tessellate/level.h"

namespace frontmost::test {
namespace {

View looking_at_origin(const glm::dvec3& eye) {
  View view;
  view.width = 640, view.height = 480;
  view.world_from_eye = look_at(eye, {0, 1.2, 0}, {0, 1, 0});
  view.projection = make_projection(glm::radians(35.0), 4.0 / 3, {0.5, 100});
  return view;
}

glm::dvec2 screen_of(const View& view, const glm::dvec3& world) {
  const glm::dvec3 eye(glm::inverse(view.world_from_eye) * glm::dvec4(world, 1));
  const double w = view.projection.orthographic ? 1 : -eye.z;
  const Projection& p = view.projection;
  return {(eye.x / w - p.left) / (p.right - p.left) * view.width,
          (p.top - eye.y / w) / (p.top - p.bottom) * view.height};
}

/// Greatest screen distance between points of the triangles and points of the surface with the same texture
/// coordinates. The patches of `scene` use the unit square as texture coordinates.
double worst_pixels(const Scene& scene, const View& view) {
  double worst = 0;
  const Instance& instance = scene.instances[0];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const auto count = std::uint32_t(mesh.triangles.size()), step = 1 + count / 4000;  // many are alike
  for (std::uint32_t t = 0; t < count; t += step) {
    const BezierPatch& patch = mesh.patches[mesh.face_of(t)];
    const glm::uvec3 &c = mesh.triangles[t], &tc = mesh.corners(mesh.texcoords, t);
    for (const glm::dvec3 w : {glm::dvec3(1, 1, 1) / 3.0, glm::dvec3(0.5, 0.5, 0), glm::dvec3(0, 0.5, 0.5),
                               glm::dvec3(0.5, 0, 0.5), glm::dvec3(0.6, 0.2, 0.2)}) {
      glm::dvec3 flat(0);
      glm::dvec2 vu(0);
      for (int k = 0; k < 3; ++k) {
        flat += w[k] * glm::dvec3(mesh.positions[c[k]]);
        vu += w[k] * glm::dvec2(mesh.texcoords.values[tc[k]]);
      }
      const glm::dvec3 curved = evaluate(patch, {vu.y, 1 - vu.y}, {vu.x, 1 - vu.x}).position;
      const auto at = [&](const glm::dvec3& p) {
        return screen_of(view, glm::dvec3(instance.world_from_mesh * glm::dvec4(p, 1)));
      };
      worst = std::max(worst, glm::length(at(flat) - at(curved)));
    }
  }
  return worst;
}

Scene teapot_of_unit_textures() {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.patches = teapot_patches();
  for (BezierPatch& patch : mesh.patches) patch.texture_low = {0, 0}, patch.texture_size = {1, 1};
  scene.instances.push_back({"teapot", 0, glm::dmat4(1.0)});
  return scene;
}

using Position = std::tuple<float, float, float>;
Position position_of(const Mesh& mesh, std::uint32_t vertex) {
  const glm::vec3& p = mesh.positions[vertex];
  return {p.x, p.y, p.z};
}

/// Number of directed edges, by position, without a partner in the opposite direction.
std::size_t open_edges(const Mesh& mesh) {
  std::map<std::pair<Position, Position>, int> edges;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{position_of(mesh, t[k]), position_of(mesh, t[(k + 1) % 3])}];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    open += std::size_t(std::max(0, count - (back == edges.end() ? 0 : back->second)));
  }
  return open;
}

TEST(Tessellation, KeepsWithinThePixelsAskedFor) {
  const Scene teapot = teapot_of_unit_textures();
  for (const glm::dvec3 eye : {glm::dvec3(3, 5, 9), glm::dvec3(0, 1.5, 4), glm::dvec3(40, 20, 30)}) {
    View view = looking_at_origin(eye);
    for (const double pixels : {2.0, 0.3}) {
      const Scene cut = tessellate(teapot, view, pixels);
      const double worst = worst_pixels(cut, view);
      EXPECT_LE(worst, pixels) << pixels;
      EXPECT_GT(worst, pixels / 12) << "too fine by far";
    }
    view.projection = make_orthographic(-4, 4, -3, 3, {0.5, 100});
    EXPECT_LE(worst_pixels(tessellate(teapot, view, 0.25), view), 0.25);
  }
}

TEST(Tessellation, TakesTransformsIntoAccount) {
  Scene teapot = teapot_of_unit_textures();
  glm::dmat4& m = teapot.instances[0].world_from_mesh;
  m[0] = {0.2, 0, 0, 0}, m[1] = {0, 0.5, 1.5, 0}, m[2] = {0, -0.1, 1, 0}, m[3] = {0.3, 0, -0.5, 1};
  const View view = looking_at_origin({3, 5, 9});
  const double worst = worst_pixels(tessellate(teapot, view, 0.2), view);
  EXPECT_LE(worst, 0.2);
  EXPECT_GT(worst, 0.01);
}

/// Number of points along the edges that only one patch has.
std::size_t rim_length(const Mesh& mesh, const std::vector<PatchLevel>& levels) {
  constexpr std::size_t ends[4][4] = {{0, 1, 2, 3}, {12, 13, 14, 15}, {0, 4, 8, 12}, {3, 7, 11, 15}};
  struct Edge {
    int count = 0, level = 0;
    bool is_point = false;
  };
  std::map<std::array<Position, 4>, Edge> edges;
  const std::vector<EdgeLevels> fineness = edge_levels(mesh.patches, levels);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (std::size_t e = 0; e < 4; ++e) {
      std::array<Position, 4> points;
      for (std::size_t k = 0; k < 4; ++k) {
        const glm::vec3 at(mesh.patches[p].points[ends[e][k]]);
        points[k] = {at.x, at.y, at.z};
      }
      std::array<Position, 4> reversed = points;
      std::reverse(reversed.begin(), reversed.end());
      Edge& edge = edges[std::min(points, reversed)];
      ++edge.count;
      edge.is_point = points[0] == points[3];
      if (edge.count > 1) {
        EXPECT_EQ(edge.level, fineness[p][e]) << "neighbours differ";
      }
      edge.level = fineness[p][e];
    }
  std::size_t length = 0;
  for (const auto& [points, edge] : edges)
    if (edge.count == 1 && !edge.is_point) length += std::size_t(edge.level);
  return length;
}

TEST(Tessellation, LeavesNoGapsBetweenPatchesOfDifferentFineness) {
  const Scene teapot = teapot_of_unit_textures();
  for (const double pixels : {3.0, 0.7}) {
    const View view = looking_at_origin({1, 1.5, 3.5});
    const Scene cut = tessellate(teapot, view, pixels);
    const std::vector<PatchLevel> levels =
        level_of(teapot.meshes[0], glm::dmat4(1.0), ScreenTolerance(view, pixels)).patches;
    EXPECT_NE(*std::min_element(levels.begin(), levels.end()), *std::max_element(levels.begin(), levels.end()));
    EXPECT_EQ(open_edges(cut.meshes[0]), rim_length(cut.meshes[0], levels));
  }
}

TEST(Tessellation, OfASphereIsWithinThePixelsAskedFor) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.spheres = {{{0.5, 1, 0}, 1.5}};
  scene.instances.push_back({"ball", 0, glm::dmat4(1.0)});
  const View view = looking_at_origin({3, 5, 9});
  std::size_t before = 0;
  for (const double pixels : {2.0, 0.5, 0.1, 0.02}) {
    const Scene cut = tessellate(scene, view, pixels);
    const Mesh& globe = cut.meshes[0];
    EXPECT_GT(globe.triangles.size(), before);
    before = globe.triangles.size();
    double worst = 0;
    for (const glm::uvec3& t : globe.triangles) {
      const glm::dvec3 a(globe.positions[t.x]), b(globe.positions[t.y]), c(globe.positions[t.z]);
      for (const glm::dvec3 flat : {(a + b + c) / 3.0, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5}) {
        const glm::dvec3 centre(0.5, 1, 0), on = centre + glm::normalize(flat - centre) * 1.5;
        worst = std::max(worst, glm::length(screen_of(view, flat) - screen_of(view, on)));
      }
    }
    EXPECT_LE(worst, pixels);
    EXPECT_GT(worst, pixels / 4);
    EXPECT_EQ(open_edges(globe), 0u);
  }
}

// The exact worst case for a globe is the middle of a cell's diagonal at the equator, where the bound is reached.
TEST(Tessellation, KnowsHowFarAGlobeIsFromTheSphere) {
  for (const int rings : {4, 9, 24, 100}) {
    const Mesh globe = sphere(rings);
    double worst = 0;
    for (const glm::uvec3& t : globe.triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 a(globe.positions[t[k]]), b(globe.positions[t[(k + 1) % 3]]);
        worst = std::max(worst, 1 - glm::length((a + b) * 0.5));
      }
    EXPECT_LE(worst, globe_error(rings) + 1e-6) << rings;
    EXPECT_GE(worst, globe_error(rings) * 0.9 - 1e-6) << rings;
  }
}

TEST(Tessellation, GivesInstancesWhatEachNeedsAndSharesTheRest) {
  Scene scene;
  Mesh& ball = scene.meshes.emplace_back();
  ball.spheres = {Sphere{}};
  scene.meshes.push_back(box({0, 0, 0}, {1, 1, 1}));
  const auto place = [&](std::uint32_t mesh, const glm::dvec3& at) {
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(at, 1);
    scene.instances.push_back({"", mesh, m});
  };
  place(0, {0, 0, 0}), place(1, {2, 0, 0}), place(0, {0, 0, -60}), place(0, {0, 0, 0});
  const Scene cut = tessellate(scene, looking_at_origin({0, 1, 9}), 0.2);
  EXPECT_EQ(cut.instances[0].mesh, 0u);
  EXPECT_EQ(cut.instances[1].mesh, 1u);
  EXPECT_EQ(cut.instances[2].mesh, 2u);
  EXPECT_EQ(cut.instances[3].mesh, 0u);
  EXPECT_GT(cut.meshes[0].triangles.size(), 4 * cut.meshes[2].triangles.size());
  EXPECT_EQ(cut.meshes[1].positions, scene.meshes[1].positions);
  EXPECT_TRUE(cut.meshes[2].is_curved());
  // Shared meshes count once, and meshes that are not curved do not count.
  const double made = double(cut.meshes[0].triangles.size() + cut.meshes[2].triangles.size());
  EXPECT_GE(tessellated_count(scene, looking_at_origin({0, 1, 9}), 0.2), made);
  EXPECT_LT(tessellated_count(scene, looking_at_origin({0, 1, 9}), 0.2), 1.1 * made);
  EXPECT_NO_THROW(validate(cut));
}

TEST(Tessellation, SaysWhichPrimitiveATriangleComesFrom) {
  Scene scene = teapot_of_unit_textures();
  scene.meshes[0].spheres = {{{0, 5, 0}, 1}, {{3, 5, 0}, 0.5}};
  const Scene cut = tessellate(scene, looking_at_origin({3, 5, 12}), 1);
  const Mesh& mesh = cut.meshes[0];
  ASSERT_EQ(mesh.face_ids.size(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::dvec3 p(mesh.positions[mesh.triangles[t].x]);
    const std::uint32_t face = mesh.face_of(t);
    if (face < 2) {
      EXPECT_NEAR(glm::length(p - mesh.spheres[face].centre), mesh.spheres[face].radius, 1e-5);
    } else {
      const glm::dvec2 vu(mesh.texcoords.values[mesh.corners(mesh.texcoords, t).x]);
      const PatchPoint on = evaluate(mesh.patches[face - 2], {vu.y, 1 - vu.y}, {vu.x, 1 - vu.x});
      EXPECT_LT(glm::length(on.position - p), 1e-5);
    }
  }
}

TEST(Tessellation, RefusesWhatCannotBe) {
  const Scene teapot = builtin("teapot");
  const View view = looking_at_origin({3, 5, 9});
  EXPECT_THROW((void)tessellate(teapot, view, 0), Error);
  EXPECT_THROW((void)tessellate(teapot, view, -1), Error);
  EXPECT_THROW((void)tessellate(teapot, view, std::nan("")), Error);
  EXPECT_THROW((void)tessellate(teapot, View(), 1), Error);
  try {
    (void)tessellate(teapot, view, 1e-9);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
  }
  EXPECT_GT(tessellated_count(teapot, view, 1e-9), 1 << 26);
}

TEST(Tessellation, SurvivesWhatIsNoSurface) {
  Scene scene = teapot_of_unit_textures();
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  scene.meshes[0].patches[0].points[5].x = nan;
  scene.meshes[0].patches[1].points[0].y = inf;
  for (glm::dvec3& p : scene.meshes[0].patches[2].points) p = {1, 1, 1};
  for (const std::size_t p : {4, 7, 8}) scene.meshes[0].patches[p].points[p].z = nan;  // on edges, which have no order
  scene.meshes[0].spheres = {{{0, 0, 0}, -1}, {{0, 0, 0}, nan}, {{nan, 0, 0}, 1}};
  const Scene cut = tessellate(scene, looking_at_origin({3, 5, 9}), 0.5);
  EXPECT_NO_THROW(validate(cut));
  const Surfaces surfaces(cut);
  EXPECT_GT(surfaces.primitive_count(), 100u);
  Scene singular = teapot_of_unit_textures();
  singular.instances[0].world_from_mesh = glm::dmat4(0.0);
  EXPECT_NO_THROW((void)tessellate(singular, looking_at_origin({3, 5, 9}), 0.5));
}

}  // namespace
}  // namespace frontmost::test
