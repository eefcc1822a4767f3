// SPDX-License-Identifier: Apache-2.0
// What is round in a mesh: circles among its sharp edges, cylinders among its smooth surfaces, and other surfaces of
// revolution.
//
//    sharp edges --chains--> arcs --on one circle--> circles ------+
//                                                                  v
//    smooth neighbours ------------------------------> walls: cylinders that begin at circles, then the others
//    what is left, and closes around an axis --------> surfaces of revolution
//
// Meshes hold polygons where there were circles. What was round is told by steps that are even, corners that lie on one
// circle as exactly as the file's digits say, and sides that are all alike.
#pragma once

#include <vector>

#include "rounds/round_fit.h"
#include "rounds/smooth_mesh.h"

namespace frontmost::lines_detail {

// Circles among the sharp edges of a mesh.

/// A circle, or arcs of it.
struct FoundCircle {
  struct Arc {
    glm::dvec3 from, to;  ///< its ends, in the direction in which the circle runs
    double turn;          ///< radians, above 0; 2 pi for all of the circle
  };

  Circle3 circle;
  std::vector<Arc> arcs;                 ///< may lie on each other
  std::vector<std::uint32_t> triangles;  ///< with a side on it
};

/// How much of the circle its arcs cover, in radians.
[[nodiscard]] double covered(const FoundCircle& circle);

/// Arcs of one circle are one. Near-linear in the sharp edges.
[[nodiscard]] std::vector<FoundCircle> find_circles(const SmoothMesh& mesh, const Execution& execution);

// Cylinders among the smooth surfaces of a mesh.

struct FoundWall {
  glm::dvec3 from, to, axis;  ///< the ends of its axis; of unit length
  double radius, turn;        ///< how much of it is there: radians, at most 2 pi
  bool is_hollow;
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// Those at the circles first, in their order, and what is cut between its ends last. Each triangle belongs to one at
/// most. O(triangles log triangles).
[[nodiscard]] std::vector<FoundWall> find_walls(const SmoothMesh& mesh, const std::vector<FoundCircle>& circles,
                                                const Execution& execution);

// Smooth surfaces of revolution that are no cylinders: tori, domes, spheres, cones, the bodies of bottles.

struct FoundRevolved {
  glm::dvec3 from, to, axis;             ///< where it begins and ends along its axis; of unit length
  double radius;                         ///< the largest
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// Those that go all the way round, and whose corners lie in rings about the axis, as programs make them. Each is all
/// that is smooth from one triangle to the next. O(triangles log triangles).
[[nodiscard]] std::vector<FoundRevolved> find_revolved(const SmoothMesh& mesh, const Execution& execution);

// Cylinders of too few sides to be round.

struct FoundPrism {
  Circle3 rim;           ///< one end: the circle through the corners
  glm::dvec3 other_end;  ///< the middle of the other end
};

/// Cylinders of 7 to 17 sides with a sharp rim at either end. O(sharp edges log sharp edges), and at worst 4096 for
/// each rim.
[[nodiscard]] std::vector<FoundPrism> find_prisms(const SmoothMesh& mesh, const Execution& execution);

}  // namespace frontmost::lines_detail
