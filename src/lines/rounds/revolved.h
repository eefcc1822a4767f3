// SPDX-License-Identifier: Apache-2.0
// Smooth surfaces of revolution that are no cylinders: tori, domes, spheres, cones, the bodies of bottles.
#pragma once

#include <vector>

#include "lines/rounds/smooth_mesh.h"

namespace frontmost::lines_detail {

struct FoundRevolved {
  glm::dvec3 from, to, axis;             ///< where it begins and ends along its axis; of unit length
  double radius;                         ///< the largest
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// Those that go all the way round, and whose corners lie in rings about the axis, as programs make them. Each is all
/// that is smooth from one triangle to the next. O(triangles log triangles).
[[nodiscard]] std::vector<FoundRevolved> find_revolved(const SmoothMesh& mesh, const Execution& execution);

}  // namespace frontmost::lines_detail
