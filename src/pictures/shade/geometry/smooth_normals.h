// SPDX-License-Identifier: Apache-2.0
// Normals for meshes without normals: smooth where facets meet at a small angle, sharp where they meet at a large one.
// So scans look smooth, and the edges of machined parts stay edges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "frontmost/scene.h"

namespace frontmost::shading {

/// A direction in 4 bytes, to about 0.003 degrees: octahedral mapping to a square.
struct PackedNormal {
  std::int16_t x = 0, y = 0;
};
[[nodiscard]] PackedNormal pack(const glm::vec3& direction);
/// The result is not normalized.
[[nodiscard]] glm::vec3 unpack(PackedNormal packed);

/// Facets that meet at a larger angle keep an edge between them.
inline constexpr double crease_cosine = 0.766044443118978;  // 40 degrees

/// Corner normals in mesh space, by triangle. Normals of triangles that were not requested are undefined.
using PackedCornerNormals = Buffer<std::array<PackedNormal, 3>>;

/// A normal for each corner of the triangles for which `is_wanted` is true: the mean of the facet normals at the
/// corner's exact position, weighted by area and by the angle at the corner. Only facets within the crease angle of the
/// corner's own facet count. Degenerate facets do not count; their normals are arbitrary. O(triangles).
[[nodiscard]] PackedCornerNormals smooth_normals(const Mesh& mesh, const std::function<bool(std::uint32_t)>& is_wanted,
                                                 const Execution& execution = {});

}  // namespace frontmost::shading
