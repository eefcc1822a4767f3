// SPDX-License-Identifier: Apache-2.0
// Drawings of collected models: against every triangle, against the z-buffer, and by the lengths of another system's
// drawings.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "frontmost/frontmost.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/point_oracle.h"
#include "support/random_scene.h"
#include "view/sight.h"

namespace frontmost::test {
namespace {

constexpr const char* names[] = {"cad/as1.stl", "cad/crank-arm.stl", "cad/torus.stl", "cad/two-cylinders.stl",
                                 "cad/rocker-arm.obj"};

/// Views from outside, in both projections, and from the middle of the model.
std::vector<View> views_of(const Surfaces& surfaces) {
  std::vector<View> views = {frame(surfaces, 320, 240), frame(surfaces, 320, 240, {.orthographic = true})};
  View inside = views[0];
  inside.world_from_eye[3] = glm::dvec4(glm::dvec3(surfaces.bounds().centre()), 1);
  inside.projection.clip.near = double(surfaces.bounds().diagonal()) / 50;
  views.push_back(inside);
  return views;
}

TEST(DrawnModels, PointsOfPartsAreHiddenWhereATriangleIsBefore) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t asked = 0, certain = 0;
  for (const char* name : names) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    Random random(1);
    for (const View& view : views_of(surfaces)) {
      const Drawing drawing = draw_lines(surfaces, view);
      const PointOracle oracle(surfaces, view);
      const std::size_t step = 1 + drawing.parts.size() / (tries_little ? 20 : 150);
      for (std::size_t i = 0; i < drawing.parts.size(); i += step) {
        const DrawnPart& part = drawing.parts[i];
        const DrawnEdge& edge = drawing.edges[part.edge];
        const double t = part.begin + (part.end - part.begin) * random.within(0.1f, 0.9f);
        const PointOracle::Answer answer = oracle.ask(edge.from + (edge.to - edge.from) * t, edge);
        ++asked;
        if (!answer.is_certain) continue;
        ++certain;
        EXPECT_EQ(part.hidden_by != 0, answer.hidden_by != 0) << part.edge << " at " << t;
      }
    }
  }
  EXPECT_GT(certain, asked / 2);
  std::cout << asked << " points, " << asked - certain << " of them within rounding of another answer\n";
}

/// Marks pixels within one pixel of a visible part.
std::vector<bool> near_lines(const Drawing& drawing, int width, int height) {
  std::vector<bool> near(std::size_t(width) * std::size_t(height), false);
  for (const DrawnPart& part : drawing.parts) {
    if (part.hidden_by != 0) continue;
    const int steps = 1 + int(4 * glm::distance(part.from, part.to));
    for (int i = 0; i <= steps; ++i) {
      const glm::dvec2 p = part.from + (part.to - part.from) * (double(i) / steps);
      for (int y = int(p.y) - 1; y <= int(p.y) + 1; ++y)
        for (int x = int(p.x) - 1; x <= int(p.x) + 1; ++x)
          if (x >= 0 && y >= 0 && x < width && y < height)
            near[std::size_t(y) * std::size_t(width) + std::size_t(x)] = true;
    }
  }
  return near;
}

bool are_flat(const Surfaces& surfaces, PrimitiveId a, PrimitiveId b) {
  if (a == no_primitive || b == no_primitive) return false;
  const auto t = surfaces.corners(a), u = surfaces.corners(b);
  const FacePlane plane{glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])};
  for (const glm::vec3& corner : u)
    if (plane.height(glm::dvec3(corner)).sign != 0) return false;
  return true;
}

/// Models with holes, borders between objects, and parts that intersect. nonmanifold-crash.obj is left out: its sheets
/// are a rounding error apart, so the z-buffer shows now one and now the other.
constexpr const char* others[] = {"cad/fandisk.obj",
                                  "cad/linkrod.glb",
                                  "assembly/as1.glb",
                                  "hero/suzanne.glb",
                                  "difficult/self-intersect-a.obj",
                                  "difficult/handmade/interpenetrating-planes.obj",
                                  "difficult/handmade/t-junction.obj"};

TEST(DrawnModels, BordersOfSeenTrianglesLieOnDrawnLines) {
  FRONTMOST_NEEDS_MODELS();
  std::vector<Scene> scenes;
  for (const char* name : names) scenes.push_back(load(model(name)));
  for (const char* name : others) scenes.push_back(load(model(name)));
  for (const char* name : {"cubes", "city"}) scenes.push_back(builtin(name));
  std::size_t borders = 0, bare = 0;
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    const Surfaces surfaces(scene);
    for (const View& view : views_of(surfaces)) {
      const Visible visible = zbuffer(surfaces, view);
      const std::vector<bool> near =
          near_lines(draw_lines(surfaces, view, {.crease_angle = 0}), view.width, view.height);
      const auto compare = [&](std::size_t a, std::size_t b) {
        if (visible.primitives[a] == visible.primitives[b] ||
            are_flat(surfaces, visible.primitives[a], visible.primitives[b]))
          return;
        ++borders;
        // The near plane cuts a surface open here, which makes no edge.
        const bool is_cut = std::max(visible.keys[a], visible.keys[b]) > 0.98f;
        const bool is_bare = !near[a] && !near[b] && !is_cut;
        if (is_bare && bare++ < 10)
          ADD_FAILURE() << a % std::size_t(view.width) << ", " << a / std::size_t(view.width) << ": "
                        << visible.primitives[a] << " and " << visible.primitives[b];
      };
      const auto width = std::size_t(view.width);
      for (std::size_t i = 0; i + width < visible.primitives.size(); ++i) {
        if (i % width + 1 < width) compare(i, i + 1);
        compare(i, i + width);
      }
    }
  }
  EXPECT_GT(borders, 10000u);
  EXPECT_EQ(bare, 0u) << "of " << borders;
}

struct Reference {
  const char* name;
  glm::dvec3 towards_viewer;
  double length, tolerance;
};

/// Visible lengths by Open CASCADE's exact hidden-line removal of the original shapes, without its smooth seams. The
/// tolerance is due to the tessellation: silhouettes zigzag between its triangles.
constexpr Reference references[] = {{"cad/as1.stl", {1, -1, 1}, 2444.05, 0.002},
                                    {"cad/as1.stl", {0.31, -0.82, 0.48}, 2317.3, 0.002},
                                    {"cad/two-cylinders.stl", {0, -1, 0}, 160, 0.0001},
                                    {"cad/two-cylinders.stl", {1, -1, 1}, 203.49, 0.005},
                                    {"cad/two-cylinders.stl", {0, 0, 1}, 112.77, 0.005},
                                    {"cad/two-cylinders.stl", {0.31, -0.82, 0.48}, 203.5, 0.005},
                                    {"cad/torus.stl", {0, 0, 1}, 375.91, 0.005},
                                    {"cad/torus.stl", {1, -1, 1}, 302.41, 0.05},
                                    {"cad/torus.stl", {0.31, -0.82, 0.48}, 288.84, 0.05},
                                    {"cad/crank-arm.stl", {1, -1, 1}, 1079.29, 0.02},
                                    {"cad/crank-arm.stl", {0.31, -0.82, 0.48}, 1117.46, 0.02}};

TEST(DrawnModels, AreAsLongAsAnotherSystemDrawsThem) {
  FRONTMOST_NEEDS_MODELS();
  for (const Reference& reference : references) {
    const Scene scene = load(model(reference.name));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 1000, 1000, {.orthographic = true, .forward = -reference.towards_viewer});
    const double unit = (view.projection.right - view.projection.left) / view.width;
    double length = 0;
    for (const DrawnPart& part : draw_lines(surfaces, view).parts)
      if (part.hidden_by == 0) length += glm::distance(part.from, part.to) * unit;
    EXPECT_NEAR(length, reference.length, reference.tolerance * reference.length) << reference.name;
    std::cout << reference.name << ": " << length << " seen, beside " << reference.length << "\n";
  }
}

glm::dvec3 right_of(const glm::dvec3& towards_viewer) {
  return glm::normalize(glm::cross(glm::dvec3(0, 0, 1), towards_viewer));
}

/// Projected length of a closed curve, t = 0 to 2 pi, seen from direction `towards_viewer`.
template <class Curve>
double seen_length(const Curve& curve, const glm::dvec3& towards_viewer) {
  const glm::dvec3 d = glm::normalize(towards_viewer), right = right_of(d), up = glm::cross(d, right);
  const auto at = [&](int i) {
    const glm::dvec3 p = curve(2 * 3.14159265358979323846 * i / 2000);
    return glm::dvec2(glm::dot(p, right), glm::dot(p, up));
  };
  double length = 0;
  for (int i = 0; i < 2000; ++i) length += glm::distance(at(i), at(i + 1));
  return length;
}

double circle_length(double radius, const glm::dvec3& towards_viewer) {
  return seen_length([&](double t) { return radius * glm::dvec3(std::cos(t), std::sin(t), 0); }, towards_viewer);
}

/// Length of the circles of two cylinders, one on the other, and of the four sides.
double cylinders_length(const glm::dvec3& towards_viewer) {
  const double upright = glm::length(glm::dvec2(towards_viewer)) / glm::length(towards_viewer);
  return 2 * circle_length(10, towards_viewer) + 2 * circle_length(8, towards_viewer) + 2 * (30 + 22) * upright;
}

struct HiddenReference {
  const char* name;
  glm::dvec3 towards_viewer;
  double (*all)(const glm::dvec3&);  ///< length of visible and hidden lines, by formula
  double seen, tolerance;            ///< by Open CASCADE; as a share of `all`
};

// The stored drawings have no hidden lines. If all lines of a shape are known by formula, the hidden ones are the rest.
constexpr HiddenReference hidden_references[] = {
    {"cad/two-cylinders.stl", {1, -1, 1}, cylinders_length, 203.49, 0.01},
    {"cad/two-cylinders.stl", {0.31, -0.82, 0.48}, cylinders_length, 203.5, 0.01}};

TEST(DrawnModels, HideAsMuchAsAnotherSystemLeavesOut) {
  FRONTMOST_NEEDS_MODELS();
  for (const HiddenReference& reference : hidden_references) {
    const Scene scene = load(model(reference.name));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 1000, 1000, {.orthographic = true, .forward = -reference.towards_viewer});
    const double unit = (view.projection.right - view.projection.left) / view.width;
    double hidden = 0;
    for (const DrawnPart& part : draw_lines(surfaces, view).parts)
      if (part.hidden_by != 0) hidden += glm::distance(part.from, part.to) * unit;
    const double all = reference.all(reference.towards_viewer);
    EXPECT_NEAR(hidden, all - reference.seen, reference.tolerance * all) << reference.name << " of " << all;
    std::cout << reference.name << ": " << hidden << " hidden, and " << all - reference.seen << " left out\n";
  }
}

/// The two projected silhouettes of a torus of radii 30 and 10 about z: closed curves in its unit, y up.
std::array<std::vector<glm::dvec2>, 2> torus_silhouettes(const glm::dvec3& towards_viewer) {
  const glm::dvec3 d = glm::normalize(towards_viewer), right = right_of(d), up = glm::cross(d, right);
  std::array<std::vector<glm::dvec2>, 2> curves;
  constexpr int steps = 4000;
  for (int i = 0; i <= steps; ++i) {
    const double u = 2 * 3.14159265358979323846 * i / steps;
    const glm::dvec3 outwards(std::cos(u), std::sin(u), 0);
    // The normal cos v * outwards + sin v * z is perpendicular to d.
    const double v = std::atan2(-glm::dot(outwards, d), d.z);
    for (int side = 0; side < 2; ++side) {
      const double r = side == 0 ? 10 : -10;
      const glm::dvec3 p = (30 + r * std::cos(v)) * outwards + glm::dvec3(0, 0, r * std::sin(v));
      curves[side].push_back({glm::dot(p, right), glm::dot(p, up)});
    }
  }
  return curves;
}

/// Points along the visible or the hidden parts of a drawing in parallel projection, in the scene's unit.
std::vector<glm::dvec2> points_along(const Drawing& drawing, bool hidden) {
  const View& view = drawing.view;
  const Projection& p = view.projection;
  const double unit = (p.right - p.left) / view.width;
  const glm::dvec2 corner =
      glm::dvec2(p.left, p.top) + glm::dvec2(glm::dot(view.eye(), view.right()), glm::dot(view.eye(), view.up()));
  std::vector<glm::dvec2> points;
  for (const DrawnPart& part : drawing.parts) {
    if ((part.hidden_by != 0) != hidden) continue;
    const int steps = 1 + int(glm::distance(part.from, part.to) * unit / 0.02);
    for (int i = 0; i <= steps; ++i) {
      const glm::dvec2 at = (part.from + (part.to - part.from) * (double(i) / steps)) * unit;
      points.push_back(corner + glm::dvec2(at.x, -at.y));
    }
  }
  return points;
}

bool is_near(const std::vector<glm::dvec2>& points, const glm::dvec2& place, double reach) {
  return std::any_of(points.begin(), points.end(),
                     [&](const glm::dvec2& p) { return glm::distance(p, place) < reach; });
}

// Where a torus curves away from the eye, the silhouettes of its triangles zigzag, all of them hidden: 40 of 300 too
// long. So the test measures how much of the true silhouette has no visible part, and checks that hidden parts cover
// all of that.
TEST(DrawnModels, HideAsMuchOfATorusAsAnotherSystemLeavesOut) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(model("cad/torus.stl"));
  const Surfaces surfaces(scene);
  constexpr Reference views[] = {{"iso", {1, -1, 1}, 302.41, 0.005}, {"skew", {0.31, -0.82, 0.48}, 288.84, 0.005}};
  constexpr double reach = 0.03;  // half of the mesh's possible distance from the torus
  for (const Reference& reference : views) {
    SCOPED_TRACE(reference.name);
    const Drawing drawing =
        draw_lines(surfaces, frame(surfaces, 1000, 1000, {.orthographic = true, .forward = -reference.towards_viewer}));
    const std::vector<glm::dvec2> seen = points_along(drawing, false), hidden = points_along(drawing, true);
    double all = 0, left_out = 0, bare = 0;
    for (const std::vector<glm::dvec2>& curve : torus_silhouettes(reference.towards_viewer))
      for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        const double length = glm::distance(curve[i], curve[i + 1]);
        all += length;
        if (is_near(seen, curve[i], reach)) continue;
        left_out += length;
        if (!is_near(hidden, curve[i], 10 * reach)) bare += length;
      }
    EXPECT_NEAR(left_out, all - reference.length, reference.tolerance * all) << "of " << all;
    EXPECT_EQ(bare, 0);
    std::cout << reference.name << ": " << left_out << " hidden, and " << all - reference.length << " left out, of "
              << all << "; " << bare << " bare\n";
  }
}

}  // namespace
}  // namespace frontmost::test
