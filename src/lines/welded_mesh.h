// SPDX-License-Identifier: Apache-2.0
// All triangles of a scene over vertices that are shared wherever they lie at one place.
#pragma once

#include "frontmost/surfaces.h"

namespace frontmost::lines_detail {

struct WeldedMesh {
  Buffer<glm::dvec3> positions;  ///< world space, all of them floats
  /// Three different vertices each, counter-clockwise seen from the front.
  Buffer<glm::uvec3> triangles;
  Buffer<PrimitiveId> ids;  ///< of the triangles
};

/// Leaves out triangles with a corner that is not finite, and those with two corners at one place. O(triangles).
/// Vertices are numbered in the order in which their places come.
[[nodiscard]] WeldedMesh weld(const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::lines_detail
