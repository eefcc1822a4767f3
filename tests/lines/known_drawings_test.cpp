// SPDX-License-Identifier: Apache-2.0
// Drawings whose every part is known.
#include <gtest/gtest.h>

#include <numbers>

#include "frontmost/lines.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

View view_from(const glm::dvec3& eye, bool is_parallel) {
  View view;
  view.width = view.height = 200;
  view.world_from_eye =
      look_at(eye, glm::dvec3(0), std::abs(eye.y) > 0.9 * glm::length(eye) ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0));
  view.projection = is_parallel ? make_orthographic(-2, 2, -2, 2, {0.5, 50}) : make_projection(0.6, 1, {0.5, 50});
  return view;
}

/// A box with outward faces, without shared vertices.
Mesh box(const glm::vec3& low, const glm::vec3& high) {
  const auto corner = [&](int x, int y, int z) {
    return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  Mesh mesh;
  add_quad(mesh, corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
  add_quad(mesh, corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  add_quad(mesh, corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
  add_quad(mesh, corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
  add_quad(mesh, corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
  add_quad(mesh, corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
  return mesh;
}

std::size_t count(const Drawing& drawing, EdgeKind kind) {
  std::size_t n = 0;
  for (const DrawnEdge& edge : drawing.edges) n += edge.kind == kind;
  return n;
}

TEST(KnownDrawings, ACubeHasNineEdgesSeenAndThreeHidden) {
  for (const bool is_parallel : {false, true}) {
    const Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
    const Drawing drawing = draw_lines(Surfaces(scene), view_from({4, 5, 6}, is_parallel));
    EXPECT_EQ(drawing.edges.size(), 12u);
    EXPECT_EQ(count(drawing, EdgeKind::silhouette), 6u);
    EXPECT_EQ(count(drawing, EdgeKind::crease), 6u);
    ASSERT_EQ(drawing.parts.size(), 12u);
    std::size_t hidden = 0;
    for (const DrawnPart& part : drawing.parts) {
      EXPECT_EQ(part.begin, 0);
      EXPECT_EQ(part.end, 1);
      const DrawnEdge& edge = drawing.edges[part.edge];
      const bool meets_far_corner = edge.from == glm::dvec3(-1) || edge.to == glm::dvec3(-1);
      EXPECT_EQ(part.hidden_by != 0, meets_far_corner);
      hidden += part.hidden_by != 0;
    }
    EXPECT_EQ(hidden, 3u);
  }
}

TEST(KnownDrawings, ACubeFromTheFrontHidesItsBackEdgesBehindItsFrontOnes) {
  const Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true));
  for (const DrawnPart& part : drawing.parts) {
    const DrawnEdge& edge = drawing.edges[part.edge];
    // Parts exactly behind the front face's outline count as hidden, and so do edges that are seen as points.
    const bool is_front = edge.from.z > 0 && edge.to.z > 0;
    EXPECT_EQ(part.hidden_by == 0, is_front) << edge.from.z << " " << edge.to.z;
  }
}

/// A prism from y = 0 to 1 over a profile in x and z, all of which is seen from its first vertex.
Mesh prism(const std::vector<glm::vec2>& profile) {
  Mesh mesh;
  const auto at = [&](std::size_t i, float y) {
    const glm::vec2& p = profile[i % profile.size()];
    return glm::vec3(p.x, y, p.y);
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    add_quad(mesh, at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1));
    if (i == 0 || i + 1 == profile.size()) continue;
    add_triangle(mesh, at(0, 0), at(i, 0), at(i + 1, 0));
    add_triangle(mesh, at(0, 1), at(i + 1, 1), at(i, 1));
  }
  return mesh;
}

TEST(KnownDrawings, StairsAndABracketHideThreeEdges) {
  const std::vector<glm::vec2> stairs = {{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 3}, {0, 3}};
  const std::vector<glm::vec2> bracket = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (const std::vector<glm::vec2>& profile : {stairs, bracket})
    for (const bool is_parallel : {false, true}) {
      const Scene scene = scene_of(prism(profile));
      View view = view_from({20, 25, 30}, is_parallel);
      if (is_parallel) view.projection = make_orthographic(-4, 4, -4, 4, {0.5, 80});
      const Drawing drawing = draw_lines(Surfaces(scene), view);
      EXPECT_EQ(drawing.edges.size(), 3 * profile.size());
      ASSERT_EQ(drawing.parts.size(), drawing.edges.size());
      std::size_t hidden = 0;
      for (const DrawnPart& part : drawing.parts) {
        // The steps rise away from the eye: hidden are the common edges of bottom, back and far side.
        const DrawnEdge& edge = drawing.edges[part.edge];
        const auto both = [&](int axis) { return edge.from[axis] == 0 && edge.to[axis] == 0; };
        const bool is_behind = int(both(0)) + int(both(1)) + int(both(2)) == 2;
        EXPECT_EQ(part.hidden_by != 0, is_behind);
        hidden += part.hidden_by != 0;
      }
      EXPECT_EQ(hidden, 3u);
    }
}

TEST(KnownDrawings, APlateCutsTheEdgesBehindItWhereItEnds) {
  // The square from -0.5 to 0.5 at z = 1 in front of that from -1 to 1 at z = 0; one is shifted so that edges are cut.
  Mesh mesh;
  add_quad(mesh, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  add_quad(mesh, {0.5, -0.5, 1}, {1.5, -0.5, 1}, {1.5, 0.25, 1}, {0.5, 0.25, 1});
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true), {.counts_hidden = true});
  EXPECT_EQ(drawing.edges.size(), 8u);  // diagonals are flat
  EXPECT_EQ(count(drawing, EdgeKind::boundary), 8u);
  EXPECT_EQ(drawing.parts.size(), 10u);
  for (const DrawnPart& part : drawing.parts) {
    const DrawnEdge& edge = drawing.edges[part.edge];
    if (edge.from.x != 1 || edge.to.x != 1) {
      EXPECT_EQ(part.hidden_by, 0u);
      continue;
    }
    // The right edge of the square behind runs from y = -1 to 1.
    EXPECT_EQ(edge.from.y, -1);
    const double y0 = -1 + 2 * part.begin, y1 = -1 + 2 * part.end;
    EXPECT_EQ(part.hidden_by, y0 < -0.5 || y1 > 0.25 ? 0u : 1u);
    EXPECT_TRUE(y0 == -1 || y0 == -0.5 || y0 == 0.25) << y0;
    EXPECT_TRUE(y1 == 1 || y1 == -0.5 || y1 == 0.25) << y1;
    EXPECT_DOUBLE_EQ(part.from.y, 100 - 50 * y0);
    EXPECT_DOUBLE_EQ(part.from.x, 150);
  }
}

TEST(KnownDrawings, LayersAreCounted) {
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
    add_quad(mesh, {-1, -1, float(i)}, {1, -1, float(i)}, {1, 1, float(i)}, {-1, 1, float(i)});
  add_quad(mesh, {-0.5f, -0.5f, -1}, {0.5f, -0.5f, -1}, {0.5f, 0.5f, -1}, {-0.5f, 0.5f, -1});
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true), {.counts_hidden = true});
  for (const DrawnPart& part : drawing.parts) {
    const double z = drawing.edges[part.edge].from.z;
    EXPECT_EQ(part.hidden_by, std::uint32_t(z < 0 ? 5 : 4 - z));
  }
}

TEST(KnownDrawings, FlatNeighboursAndTwinsDrawNothingBetween) {
  Mesh mesh;
  add_quad(mesh, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
  add_quad(mesh, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(mesh, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0});  // a copy
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({1, 2, 8}, false), {.crease_angle = 0});
  EXPECT_EQ(drawing.edges.size(), 6u);
  for (const DrawnPart& part : drawing.parts) EXPECT_EQ(part.hidden_by, 0u);
}

TEST(KnownDrawings, WindingDoesNotMatter) {
  Mesh mesh = box(glm::vec3(-1), glm::vec3(1));
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) std::swap(mesh.triangles[i].x, mesh.triangles[i].y);
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({4, 5, 6}, false));
  EXPECT_EQ(count(drawing, EdgeKind::silhouette), 6u);
  EXPECT_EQ(count(drawing, EdgeKind::crease), 6u);
  EXPECT_EQ(drawing.edges.size(), 12u);
}

TEST(KnownDrawings, BordersBetweenMaterialsAndInstances) {
  Mesh mesh;
  add_quad(mesh, {-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
  add_quad(mesh, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0});
  mesh.material_ids = {0, 0, 1, 1};
  Scene scene = scene_of(mesh);
  scene.materials.resize(2);
  const View view = view_from({1, 2, 8}, false);
  EXPECT_EQ(count(draw_lines(Surfaces(scene), view), EdgeKind::border), 1u);
  scene.instances.push_back({"above", 0, glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 2, 0, 1})});
  const Surfaces both(scene);
  // Each instance has one border, and two where the instances touch.
  EXPECT_EQ(count(draw_lines(both, view), EdgeKind::border), 4u);
}

double length_of(const Drawing& drawing, const DrawnPart& part) {
  const DrawnEdge& edge = drawing.edges[part.edge];
  return (part.end - part.begin) * glm::length(edge.to - edge.from);
}

TEST(KnownDrawings, TwoBoxesThroughEachOtherMeetInTwoSquares) {
  Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
  scene.meshes.push_back(box({-0.5f, -0.5f, -2}, {0.5f, 0.5f, 2}));
  scene.instances.push_back({"through", 1, glm::dmat4(1.0)});
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true}) {
    const Drawing drawing = draw_lines(surfaces, view_from({4, 5, 6}, is_parallel), {.counts_hidden = true});
    double seen = 0, hidden = 0;
    for (const DrawnPart& part : drawing.parts) {
      const DrawnEdge& edge = drawing.edges[part.edge];
      if (edge.kind != EdgeKind::intersection) continue;
      for (const glm::dvec3& p : {edge.from, edge.to}) {
        EXPECT_EQ(std::abs(p.z), 1);
        EXPECT_EQ(std::max(std::abs(p.x), std::abs(p.y)), 0.5);
      }
      // The upper square's two edges in front of the inner box are visible.
      const glm::dvec3 middle = (edge.from + edge.to) * 0.5;
      EXPECT_EQ(part.hidden_by == 0, middle.z == 1 && (middle.x == 0.5 || middle.y == 0.5));
      (part.hidden_by == 0 ? seen : hidden) += length_of(drawing, part);
    }
    EXPECT_NEAR(seen, 2, 1e-12);
    EXPECT_NEAR(hidden, 6, 1e-12);
    EXPECT_EQ(count(draw_lines(surfaces, view_from({4, 5, 6}, is_parallel), {.intersections = false}),
                    EdgeKind::intersection),
              0u);
  }
}

TEST(KnownDrawings, OutlinesHaveNothingBeside) {
  // A box in front of a plate: its silhouettes are contours where the plate is behind, and outlines beyond the plate.
  Mesh mesh = box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1});
  add_quad(mesh, {0, -2, -1}, {2, -2, -1}, {2, 2, -1}, {0, 2, -1});
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true), {.outlines = true});
  double outline = 0, contour = 0;
  for (const DrawnPart& part : drawing.parts) {
    const DrawnEdge& edge = drawing.edges[part.edge];
    if (part.hidden_by != 0) {
      EXPECT_FALSE(part.is_outline);
      continue;
    }
    const glm::dvec3 at = edge.from + (edge.to - edge.from) * (0.5 * (part.begin + part.end));
    if (edge.kind == EdgeKind::silhouette) {
      EXPECT_EQ(part.is_outline, at.x < 0) << at.x << " " << at.y;
    }
    (part.is_outline ? outline : contour) += length_of(drawing, part);
  }
  // The outline is the box's left half, and the plate except its hidden part.
  EXPECT_NEAR(outline, 2 + (12 - 1), 1e-12);
  EXPECT_NEAR(contour, 2, 1e-12);
  for (const DrawnPart& part : draw_lines(Surfaces(scene), view_from({0, 0, 10}, true)).parts)
    EXPECT_FALSE(part.is_outline);
}

TEST(KnownDrawings, EdgesExactlyBehindTheOutlineLeaveItOne) {
  const Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
  double outline = 0;
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true), {.outlines = true});
  for (const DrawnPart& part : drawing.parts)
    if (part.is_outline) outline += length_of(drawing, part);
  EXPECT_EQ(outline, 8);
}

TEST(KnownDrawings, KindsThatAreNotWantedAreNotDrawn) {
  const Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
  const Surfaces surfaces(scene);
  const View view = view_from({4, 5, 6}, false);
  EXPECT_EQ(draw_lines(surfaces, view, {.silhouettes = false}).edges.size(), 12u);  // they are creases, too
  EXPECT_EQ(count(draw_lines(surfaces, view, {.silhouettes = false}), EdgeKind::crease), 12u);
  EXPECT_EQ(draw_lines(surfaces, view, {.creases = false}).edges.size(), 6u);
  Mesh open;
  add_triangle(open, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Scene one = scene_of(open);
  EXPECT_TRUE(draw_lines(Surfaces(one), view, {.boundaries = false}).edges.empty());
}

TEST(KnownDrawings, WhatLiesOutsideOfTheViewIsCutOff) {
  Mesh mesh;
  add_triangle(mesh, {-1, 0, 0}, {100, 0, 0}, {-1, 100, 0});
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view_from({0, 0, 10}, true));
  ASSERT_EQ(drawing.edges.size(), 3u);
  ASSERT_EQ(drawing.parts.size(), 2u);
  for (const DrawnPart& part : drawing.parts)
    for (const glm::dvec2& p : {part.from, part.to}) {
      EXPECT_GE(p.x, -1e-9);
      EXPECT_LE(p.x, 200 + 1e-9);
      EXPECT_GE(p.y, -1e-9);
    }
}

TEST(KnownDrawings, WhatIsBeforeTheNearPlaneHidesNothing) {
  for (const bool is_parallel : {false, true}) {
    Mesh mesh;
    add_triangle(mesh, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_quad(mesh, {-3, -3, 9.8f}, {3, -3, 9.8f}, {3, 3, 9.8f}, {-3, 3, 9.8f});
    const Scene scene = scene_of(mesh);
    for (const DrawnPart& part : draw_lines(Surfaces(scene), view_from({0, 0, 10}, is_parallel)).parts)
      EXPECT_EQ(part.hidden_by, 0u);
  }
}

TEST(KnownDrawings, NothingAndNonsense) {
  const Scene empty;
  EXPECT_TRUE(draw_lines(Surfaces(empty), view_from({0, 0, 5}, false)).edges.empty());
  const Scene scene = scene_of(box(glm::vec3(-1), glm::vec3(1)));
  const Surfaces surfaces(scene);
  for (const double angle : {-0.1, 3.2, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)draw_lines(surfaces, view_from({0, 0, 5}, false), {.crease_angle = angle}), Error);
  EXPECT_EQ(draw_lines(surfaces, view_from({0, 0, 5}, false), {.crease_angle = std::numbers::pi}).edges.size(), 4u);
}

}  // namespace
}  // namespace frontmost::test
