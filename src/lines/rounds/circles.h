// SPDX-License-Identifier: Apache-2.0
// Circles among the sharp edges of a mesh.
#pragma once

#include <vector>

#include "lines/rounds/circle3.h"
#include "lines/rounds/smooth_mesh.h"

namespace frontmost::lines_detail {

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

}  // namespace frontmost::lines_detail
