// SPDX-License-Identifier: Apache-2.0
// GLUT's shapes: outward normals and counter-clockwise faces, except the teapot's, which are clockwise, as GLUT draws
// them. Solids have GLUT's sizes and axes. Cones and cylinders are closed, as in freeglut.

#include <cmath>

#include "glut/glut.h"
#include "scene/bezier_patch.h"
#include "scene/turn.h"

namespace frontmost::glut {
namespace {

using SolidPoints = std::vector<glm::dvec3>;

void send(const glm::dvec3& normal, const glm::dvec3& position) {
  glNormal3dv(&normal.x);
  glVertex3dv(&position.x);
}

/// A circle about the z axis: its radius and height, and those of its normals.
struct SurfaceRing {
  double radius, height, normal_radius, normal_height;

  void send_at(const glm::dvec2& around) const {
    send({normal_radius * around, normal_height}, {radius * around, height});
  }
};

/// Draws the surface through rings, which go down as seen from outside.
void draw_rings(bool is_wire, const std::vector<SurfaceRing>& rings, int slices) {
  if (slices < 1) return;
  std::vector<glm::dvec2> around = circle(slices);
  around.push_back(around[0]);
  for (std::size_t i = 0; i + !is_wire < rings.size(); ++i) {
    glBegin(is_wire ? GL_LINE_STRIP : GL_QUAD_STRIP);
    for (const glm::dvec2& at : around) {
      rings[i].send_at(at);
      if (!is_wire) rings[i + 1].send_at(at);
    }
    glEnd();
  }
  for (int j = 0; is_wire && j < slices; ++j) {
    glBegin(GL_LINE_STRIP);
    for (const SurfaceRing& ring : rings) ring.send_at(around[std::size_t(j)]);
    glEnd();
  }
}

void draw_sphere(bool is_wire, double radius, int slices, int stacks) {
  std::vector<SurfaceRing> rings;
  for (int i = 0; i <= stacks && stacks > 0; ++i) {
    const glm::dvec2 at = turn(i, 2LL * stacks);
    rings.push_back({radius * at.y, radius * at.x, at.y, at.x});
  }
  draw_rings(is_wire, rings, slices);
}

void draw_torus(bool is_wire, double tube, double radius, int sides, int slices) {
  std::vector<SurfaceRing> rings;
  for (int i = 0; i <= sides && sides > 0; ++i) {
    const glm::dvec2 at = turn(-i, sides);
    rings.push_back({radius + tube * at.x, tube * at.y, at.x, at.y});
  }
  draw_rings(is_wire, rings, slices);
}

/// Draws a cone that is cut off where its radius is `top`.
void draw_cone(bool is_wire, double base, double top, double height, int slices, int stacks) {
  const double slope = base - top, length = std::sqrt(height * height + slope * slope);
  std::vector<SurfaceRing> rings;
  for (int i = 0; i <= stacks && stacks > 0 && length > 0; ++i) {
    const double down = double(i) / stacks;
    rings.push_back({top + slope * down, height * (1 - down), height / length, slope / length});
  }
  draw_rings(is_wire, rings, slices);
  if (is_wire) return;
  draw_rings(false, {{base, 0, 0, -1}, {0, 0, 0, -1}}, slices);
  if (top > 0) draw_rings(false, {{0, height, 0, 1}, {top, height, 0, 1}}, slices);
}

/// Vertices of a regular solid: reflections of points in the planes of the axes, with the axes exchanged in turn. The
/// tetrahedron has those with an even number of reflections, or an odd one.
enum Solid { cube, tetrahedron, opposite_tetrahedron, octahedron, dodecahedron, icosahedron };
SolidPoints vertices_of(Solid solid) {
  const double golden = (std::sqrt(5.0) + 1) / 2;
  SolidPoints seeds{glm::dvec3(1)};
  if (solid == octahedron) seeds = {{1, 0, 0}};
  if (solid == icosahedron) seeds = {{1, 0, golden}};
  if (solid == dodecahedron) seeds.emplace_back(0, golden, golden - 1);
  SolidPoints points;
  for (glm::dvec3 p : seeds)
    for (int i = 0; i < 24; ++i) {
      const glm::dvec3 q = p * glm::dvec3(i & 1 ? -1 : 1, i & 2 ? -1 : 1, i & 4 ? -1 : 1);
      const Solid half = q.x * q.y * q.z > 0 ? tetrahedron : opposite_tetrahedron;
      const bool is_left_out = (solid == tetrahedron || solid == opposite_tetrahedron) && solid != half;
      if (!is_left_out && std::find(points.begin(), points.end(), q) == points.end()) points.push_back(q);
      if (i % 8 == 7) p = {p.z, p.x, p.y};
    }
  return points;
}

/// Draws a solid whose vertices are `radius` away from its centre. Its faces are where its dual has vertices, which
/// vertices_of() gives with x and z exchanged.
void draw_solid(bool is_wire, Solid solid, Solid dual, double radius) {
  const SolidPoints points = vertices_of(solid);
  for (const glm::dvec3& direction : vertices_of(dual)) {
    const glm::dvec3 normal = unit({direction.z, direction.y, direction.x});
    const auto below = [&](const glm::dvec3& p, const glm::dvec3& q) { return glm::dot(normal, p - q) < -1e-9; };
    const glm::dvec3 highest = *std::max_element(points.begin(), points.end(), below);
    SolidPoints face;
    for (const glm::dvec3& p : points)
      if (!below(p, highest)) face.push_back(p);
    std::sort(face.begin() + 1, face.end(), [&](const glm::dvec3& p, const glm::dvec3& q) {
      return glm::dot(normal, glm::cross(p - face[0], q - face[0])) > 0;
    });
    glBegin(is_wire ? GL_LINE_LOOP : GL_POLYGON);
    for (const glm::dvec3& p : face) send(normal, radius * unit(p));
    glEnd();
  }
}

/// Draws the teapot's patches, each in a grid as by evaluators.
void draw_teapot(bool is_wire, double size) {
  static const std::vector<BezierPatch> patches = teapot_patches();
  const int steps = is_wire ? 10 : 7;
  for (const BezierPatch& patch : patches)
    for (int i = 0; i < (is_wire ? 2 * steps + 2 : steps); ++i) {
      const auto send_point = [&](int row, int column) {
        const PatchPoint point = evaluate(patch, fraction(row, steps), fraction(column, steps));
        glTexCoord2d(double(column) / steps, double(row) / steps);
        send(point.normal, 0.5 * size * (point.position - glm::dvec3(0, 1.5, 0)));
      };
      glBegin(is_wire ? GL_LINE_STRIP : GL_QUAD_STRIP);
      for (int j = 0; j <= steps; ++j) {
        i <= steps ? send_point(i, j) : send_point(j, i - steps - 1);
        if (!is_wire) send_point(i + 1, j);
      }
      glEnd();
    }
}

}  // namespace

#define FRONTMOST_GLUT_SHAPE(name, parameters, draw, ...)                      \
  FRONTMOST_GLUT void glutSolid##name parameters { draw(false, __VA_ARGS__); } \
  FRONTMOST_GLUT void glutWire##name parameters { draw(true, __VA_ARGS__); }
FRONTMOST_GLUT_SHAPE(Cube, (double size), draw_solid, cube, octahedron, std::sqrt(0.75) * size)
FRONTMOST_GLUT_SHAPE(Tetrahedron, (), draw_solid, tetrahedron, opposite_tetrahedron, 1)
FRONTMOST_GLUT_SHAPE(Octahedron, (), draw_solid, octahedron, cube, 1)
FRONTMOST_GLUT_SHAPE(Dodecahedron, (), draw_solid, dodecahedron, icosahedron, std::sqrt(3.0))
FRONTMOST_GLUT_SHAPE(Icosahedron, (), draw_solid, icosahedron, dodecahedron, 1)
FRONTMOST_GLUT_SHAPE(Sphere, (double radius, int slices, int stacks), draw_sphere, radius, slices, stacks)
FRONTMOST_GLUT_SHAPE(Torus, (double tube, double radius, int sides, int rings), draw_torus, tube, radius, sides, rings)
FRONTMOST_GLUT_SHAPE(Cone, (double base, double height, int slices, int stacks), draw_cone, base, 0, height, slices,
                     stacks)
FRONTMOST_GLUT_SHAPE(Cylinder, (double radius, double height, int slices, int stacks), draw_cone, radius, radius,
                     height, slices, stacks)
FRONTMOST_GLUT_SHAPE(Teapot, (double size), draw_teapot, size)

}  // namespace frontmost::glut
