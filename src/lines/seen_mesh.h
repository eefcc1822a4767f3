// SPDX-License-Identifier: Apache-2.0
// A mesh as it is seen.
#pragma once

#include "lines/welded_mesh.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A mesh, and by triangle what all steps ask of it.
struct SeenMesh {
  const WeldedMesh& mesh;
  Buffer<std::int8_t> facing;  ///< Sight::facing()
  Buffer<glm::dvec3> normals;  ///< rounded, twice as long as the triangle is large
};

/// O(triangles).
[[nodiscard]] SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution);

}  // namespace frontmost::lines_detail
