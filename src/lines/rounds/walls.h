// SPDX-License-Identifier: Apache-2.0
// Cylinders among the smooth surfaces of a mesh.
#pragma once

#include <vector>

#include "lines/rounds/circles.h"

namespace frontmost::lines_detail {

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

}  // namespace frontmost::lines_detail
