// SPDX-License-Identifier: Apache-2.0
// Meshes and placements that the built-in scenes are composed of. Everything is computed in double with +, *, / and
// sqrt alone and rounded to float once, so that the scenes are bit-identical on every machine.
#pragma once

#include <functional>
#include <string>

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
  double core = 0.42;  ///< how far the curve swings about the core circle
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
/// A rectangle of quads, bent so that its first and last row, or column, may be one. Outer side: (along j) x (along i).
struct SurfaceGrid {
  int rows = 1, columns = 1;    ///< of quads; i counts rows, j columns
  bool closed_rows = false;     ///< row `rows` is row 0
  bool closed_columns = false;  ///< column `columns` is column 0
  bool poles = false;           ///< the first and the last row are one point each
};
[[nodiscard]] Mesh surface(const SurfaceGrid& grid, const std::function<SurfacePoint(int i, int j)>& point);

/// A plain material: base colour in sRGB as 0xRRGGBB.
[[nodiscard]] Material paint(std::string name, std::uint32_t srgb, float roughness = 0.6f, float metallic = 0);

/// Appends and returns the new one's number.
std::uint32_t add(Scene& scene, Material material);
/// Every triangle of the mesh gets that material.
std::uint32_t add(Scene& scene, std::string name, Mesh mesh, std::uint32_t material);
void place(Scene& scene, std::string name, std::uint32_t mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0));

[[nodiscard]] glm::dmat4 moved(const glm::dvec3& by);
[[nodiscard]] glm::dmat4 scaled(double by);
/// About the y axis, counter-clockwise seen from above, by part / whole of a full turn.
[[nodiscard]] glm::dmat4 turned(int part, int whole);

/// A camera at `eye` that looks at `target` with y up. `vertical`: full field of view in degrees.
[[nodiscard]] Camera look_at(std::string name, const glm::dvec3& eye, const glm::dvec3& target, double vertical);

/// From a colour as designers write it (0xRRGGBB, sRGB) to linear light.
[[nodiscard]] glm::vec4 color(std::uint32_t srgb, double alpha = 1);

}  // namespace frontmost
