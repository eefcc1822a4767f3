// SPDX-License-Identifier: Apache-2.0
// Meshes of which the built-in scenes are composed. Everything is computed in double with +, *, / and sqrt alone and
// rounded to float once, so the scenes are bit-identical on every machine.
#pragma once

#include <functional>
#include <span>

#include "frontmost/scene.h"

namespace frontmost {

/// An axis-aligned box with flat normals; each side carries the whole texture.
[[nodiscard]] Mesh box(const glm::dvec3& low, const glm::dvec3& high);

/// A rectangle in the plane y = 0 that faces up, about the origin; texture coordinates run from 0 to `repeats`.
[[nodiscard]] Mesh floor(double width, double depth, double repeats = 1);

/// A sphere of radius 1 about the origin with smooth normals: `rings` bands from pole to pole, twice as many around.
[[nodiscard]] Mesh sphere(int rings);

/// A (p, q) torus knot: winds p times around the y axis and q times around the core circle of radius 1.
struct KnotShape {
  int p = 2, q = 3;
  double core = 0.42;  ///< distance by which the curve swings about the core circle
  double tube = 0.17;  ///< radius of the tube
  int along = 320, around = 24;
};
[[nodiscard]] Mesh torus_knot(const KnotShape& shape);

/// The classic teapot with `steps` * `steps` quads a patch: smooth normals, no cracks.
[[nodiscard]] Mesh teapot(int steps);

/// Position and unit normal of a surface at grid point (i, j).
struct SurfacePoint {
  glm::dvec3 position, normal;
};
/// A rectangle of quads, whose first and last row, or column, may coincide. Outer side: (along j) x (along i).
struct SurfaceGrid {
  int rows = 1, columns = 1;    ///< rows and columns of quads; i counts rows, j columns
  bool closed_rows = false;     ///< row `rows` is row 0
  bool closed_columns = false;  ///< column `columns` is column 0
  bool poles = false;           ///< the first and the last row are one point each
};
[[nodiscard]] Mesh surface(const SurfaceGrid& grid, const std::function<SurfacePoint(int i, int j)>& point);

/// A point of an outline that is turned about the y axis, and the outward normal there. Two coincident points with
/// different normals make a sharp edge.
struct ProfilePoint {
  double radius, height;
  glm::dvec2 normal;  ///< (outward, up), unit length
};
/// The outline, from its top to its bottom, turned about the y axis. Closed if it starts and ends at radius 0.
[[nodiscard]] Mesh lathe(std::span<const ProfilePoint> profile, int segments);

/// A closed round slab that stands on y = 0, its upper edge rounded.
struct RoundSlab {
  double radius, height, bevel;
};
[[nodiscard]] Mesh round_slab(const RoundSlab& slab, int segments);

/// Appends a transformed part as triangles of `material`. Both meshes have normals and texture coordinates.
void append(Mesh& mesh, const Mesh& part, std::uint32_t material, const glm::dmat4& mesh_from_part = glm::dmat4(1.0));

}  // namespace frontmost
