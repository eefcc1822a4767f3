// SPDX-License-Identifier: Apache-2.0
// Round shapes in a mesh: circles among its sharp edges, cylinders among its smooth surfaces, and other surfaces of
// revolution.
//
//    sharp edges --chains--> arcs --on one circle--> circles ------+
//                                                                  v
//    smooth neighbours ------------------------------> walls: cylinders that begin at circles, then the others
//    other regions that close around an axis --------> surfaces of revolution
//
// Meshes have polygons in place of circles. A polygon counts as a circle if its steps are even, its corners lie on one
// circle to the precision of the file, and its sides are alike.
#pragma once

#include <vector>

#include "rounds/round_fit.h"
#include "rounds/smooth_mesh.h"

namespace frontmost::lines_detail {

// Circles among the sharp edges of a mesh.

/// A circle, or several arcs of it.
struct FoundCircle {
  struct Arc {
    glm::dvec3 from, to;  ///< the ends, in the circle's orientation
    double turn;          ///< radians, above 0; 2 pi for a whole circle
  };

  Circle3 circle;
  std::vector<Arc> arcs;                 ///< may overlap
  std::vector<std::uint32_t> triangles;  ///< triangles with a side on the circle
};

/// The total angle that the arcs cover, in radians.
[[nodiscard]] double covered(const FoundCircle& circle);

/// The circles of a mesh; arcs of one circle are united. Near-linear in the number of sharp edges.
[[nodiscard]] std::vector<FoundCircle> find_circles(const SmoothMesh& mesh, const Execution& execution);

// Cylinders among the smooth surfaces of a mesh.

struct FoundWall {
  glm::dvec3 from, to, axis;  ///< the ends of its axis; unit direction
  double radius, turn;        ///< `turn`: the covered angle in radians, at most 2 pi
  bool is_hollow;
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// The cylinders of a mesh: first those that begin at circles, in their order; last those that are cut between their
/// ends. Each triangle belongs to at most one. O(triangles log triangles).
[[nodiscard]] std::vector<FoundWall> find_walls(const SmoothMesh& mesh, const std::vector<FoundCircle>& circles,
                                                const Execution& execution);

// Smooth surfaces of revolution that are no cylinders: tori, domes, spheres, cones, the bodies of bottles.

struct FoundRevolved {
  glm::dvec3 from, to, axis;             ///< its ends along the axis; unit direction
  double radius;                         ///< the largest radius
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// Surfaces of revolution that are closed around the axis and have their vertices in rings about it, as programs make
/// them. Each is a whole smooth region. O(triangles log triangles).
[[nodiscard]] std::vector<FoundRevolved> find_revolved(const SmoothMesh& mesh, const Execution& execution);

// Cylinders with too few sides to be round.

struct FoundPrism {
  Circle3 rim;           ///< one end: the circle through its corners
  glm::dvec3 other_end;  ///< the middle of the other end
};

/// Cylinders of 7 to 17 sides with a sharp rim at either end. O(sharp edges log sharp edges), and at most 4096
/// comparisons for each rim.
[[nodiscard]] std::vector<FoundPrism> find_prisms(const SmoothMesh& mesh, const Execution& execution);

}  // namespace frontmost::lines_detail
