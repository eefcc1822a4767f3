// SPDX-License-Identifier: Apache-2.0
// Bounds on the distance of triangles from the curved surface, and the coarsest grids that keep within them.
//
// D. Filip, R. Magedson, R. Markot. Surface Algorithms Using Bounds on Derivatives. 1986 (patches).
//
//   how far a displacement shows:   pixels  ->  world units, by the distance from the eye (ScreenTolerance)
//   how far a grid is off:          second derivatives of a patch, over 8 u^2, 4 u v and 8 v^2 (PatchBending);
//                                   for a sphere the height of the cap over a cell of its globe (globe_error)
//
// A level is the first at which the error of the grid does not exceed the tolerated displacement. Both are upper
// bounds, never estimates, because a drawing may have to be right to so many pixels.

#include "view/tessellate/level.h"

#include <algorithm>
#include <cmath>

#include "scene/turn.h"

namespace frontmost {
namespace {

constexpr int kFewestRings = 4;

/// An upper bound of the factor by which a matrix can lengthen a vector (Gershgorin's circles about M^T M); exact for
/// rotations with a scale.
double greatest_stretch(const glm::dmat3& m) {
  const glm::dmat3 squares = glm::transpose(m) * m;
  double most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::abs(squares[k].x) + std::abs(squares[k].y) + std::abs(squares[k].z));
  return std::sqrt(most);
}

/// Doubles, then bisects: globe_error() reads all rings, and falls with their number.
int rings_within(double tolerance) {
  int rings = kFewestRings;
  while (rings < finest_level && globe_error(rings) > tolerance) rings *= 2;
  // Bisects between half of `rings` and `rings`.
  int few = rings / 2, many = rings;
  while (rings > kFewestRings && many - few > 1) {
    const int middle = (few + many) / 2;
    (globe_error(middle) > tolerance ? few : many) = middle;
  }
  return many;
}

}  // namespace

double MeshLevel::triangle_count() const {
  double count = 0;
  for (const int r : rings) count += 4.0 * r * r;
  for (const PatchLevel& level : patches) count += 2.0 * level.u * level.v;
  return count;
}

// Moving a point at distance w by e moves its image, at tangents (x, y) from the axis, by at most focal * e * sqrt(1 +
// x^2 + y^2) / w: image = focal * (X - x W) / w for a displacement (X, W).
ScreenTolerance::ScreenTolerance(const View& view, double pixels)
    : eye_(view.eye()), forward_(view.forward()), near_(view.projection.clip.near) {
  const Projection& p = view.projection;
  const double focal = std::max(view.width / (p.right - p.left), view.height / (p.top - p.bottom));
  if (p.orthographic) {
    anywhere_ = pixels / focal;
    return;
  }
  const double x = std::max(std::abs(p.left), std::abs(p.right)), y = std::max(std::abs(p.bottom), std::abs(p.top));
  per_distance_ = pixels / (focal * std::sqrt(1 + x * x + y * y));
}

double ScreenTolerance::at(double nearest, double farthest) const {
  // Nothing of it is seen, so any tessellation will do.
  if (farthest < near_) return std::numeric_limits<double>::infinity();
  return anywhere_ + std::max(nearest, near_) * per_distance_;
}

double ScreenTolerance::of(std::span<const glm::dvec3> points) const {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const glm::dvec3& p : points) {
    nearest = std::min(nearest, distance(p));
    farthest = std::max(farthest, distance(p));
  }
  return at(nearest, farthest);
}

double ScreenTolerance::of_ball(const glm::dvec3& centre, double radius) const {
  return at(distance(centre) - radius, distance(centre) + radius);
}

// Second derivatives of a Bezier surface are convex combinations of second differences of its points.
PatchBending::PatchBending(std::span<const glm::dvec3, 16> points) {
  const auto at = [&](std::size_t i, std::size_t j) { return points[4 * i + j]; };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      if (i < 2) uu_ = std::max(uu_, 6 * glm::length(at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j)));
      if (j < 2) vv_ = std::max(vv_, 6 * glm::length(at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)));
      if (i < 3 && j < 3)
        uv_ = std::max(uv_, 9 * glm::length((at(i + 1, j + 1) - at(i + 1, j)) - (at(i, j + 1) - at(i, j))));
    }
}

double PatchBending::error(const PatchLevel& level) const {
  const double u = 1.0 / level.u, v = 1.0 / level.v;
  return (uu_ * u * u + 2 * uv_ * u * v + vv_ * v * v) / 8;
}

PatchLevel PatchBending::level_within(double tolerance) const {
  PatchLevel level;
  // A control point is infinite or NaN: tessellate() leaves such patches out.
  if (!std::isfinite(error(level))) return level;  // never seen
  while (error(level) > tolerance && (level.u < finest_level || level.v < finest_level)) {
    // The direction with the greater share of the error is halved. This quarters its share, and keeps the triangles of
    // the other direction.
    const double by_u = uu_ / level.u / level.u, by_v = vv_ / level.v / level.v;
    // If only the twist remains, the longer cells are halved.
    const bool is_u = by_u != by_v ? by_u > by_v : level.u <= level.v;
    int& steps = (is_u && level.u < finest_level) || level.v >= finest_level ? level.u : level.v;
    steps *= 2;
  }
  return level;
}

// The four corners of a cell lie on a circle, whose radius R is that about a triangle of a side, a diagonal and a leg.
// The plane through them is sqrt(1 - R^2) from the centre, and no point of the cell is nearer to it.
double globe_error(int rings) {
  const double half_step = turn(1, 4 * std::int64_t(rings)).y;
  const double leg = 2 * half_step;
  double most = 0;
  for (int i = 0; i < rings; ++i) {
    // The two parallels of a ring are chords of a column's width; one of them is a point at a pole.
    const double a = 2 * turn(i, 2 * rings).y * half_step, b = 2 * turn(i + 1, 2 * rings).y * half_step;
    const double diagonal = std::sqrt(leg * leg + a * b), height = std::sqrt(leg * leg - (a - b) * (a - b) / 4);
    const double radius = leg * diagonal / (2 * height);
    most = std::max(most, radius);
  }
  return most < 1 ? 1 - std::sqrt(1 - most * most) : 1;
}

MeshLevel level_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const ScreenTolerance& tolerance) {
  MeshLevel level;
  const double stretch = greatest_stretch(glm::dmat3(world_from_mesh));
  for (const Sphere& sphere : mesh.spheres) {
    const double radius = stretch * std::max(sphere.radius, 0.0);
    const double allowed = tolerance.of_ball(glm::dvec3(world_from_mesh * glm::dvec4(sphere.centre, 1)), radius);
    level.rings.push_back(radius > 0 && std::isfinite(radius) ? rings_within(allowed / radius) : kFewestRings);
  }
  for (const BezierPatch& patch : mesh.patches) {
    std::array<glm::dvec3, 16> points;
    for (std::size_t i = 0; i < 16; ++i) points[i] = glm::dvec3(world_from_mesh * glm::dvec4(patch.points[i], 1));
    level.patches.push_back(PatchBending(points).level_within(tolerance.of(points)));
  }
  return level;
}

}  // namespace frontmost
