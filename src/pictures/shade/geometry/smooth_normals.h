// SPDX-License-Identifier: Apache-2.0
// Normals for meshes that have none: smooth where facets meet at a small angle, sharp where they meet at a large one,
// so that scans look smooth and the edges of machined parts stay edges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "frontmost/scene.h"

namespace frontmost::shading {

/// A direction in 4 bytes, to about 0.003 degrees: the octahedron's faces unfolded into a square.
struct PackedNormal {
  std::int16_t x = 0, y = 0;
};
[[nodiscard]] PackedNormal pack(const glm::vec3& direction);
/// Not normalised.
[[nodiscard]] glm::vec3 unpack(PackedNormal packed);

/// Facets that meet at more than this angle keep an edge between them.
inline constexpr double crease_cosine = 0.766044443118978;  // 40 degrees

/// Corner normals in the mesh's own space, by triangle. Those of triangles that were not asked for are undefined.
using PackedCornerNormals = Buffer<std::array<PackedNormal, 3>>;

/// For each corner of the triangles for which `is_wanted` says so: the mean of the normals of all facets that share
/// the corner's position, to the bit, and lie within the crease angle of the corner's own facet, weighted by area and
/// by the angle at the corner. Degenerate facets count for nothing and point anywhere. O(triangles).
[[nodiscard]] PackedCornerNormals smooth_normals(const Mesh& mesh, const std::function<bool(std::uint32_t)>& is_wanted,
                                                 const Execution& execution = {});

}  // namespace frontmost::shading
