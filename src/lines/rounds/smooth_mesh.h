// SPDX-License-Identifier: Apache-2.0
// A mesh with its triangles' neighbours, and what is smooth between them.
#pragma once

#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// 20.01 degrees: between two neighbours that turn by more there is an edge, and between two sides of a polygon a
/// corner. As arcs have it.
inline constexpr double kWidestStep = 0.34924038;
inline constexpr double kWidestCosine = 0.93963;

struct SmoothMesh {
  WeldedMesh mesh;
  Buffer<glm::dvec3> normals;  ///< of unit length; zero where rounding leaves no direction
  /// By triangle and side, the first from corner 0 to corner 1: the only other triangle there, wound alike. Otherwise
  /// no_index.
  Buffer<glm::uvec3> across;
  double noise = 0;  ///< by how much corners may be off their places: what six digits leave open

  [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, int k) const {
    return mesh.positions[mesh.triangles[triangle][k]];
  }
  [[nodiscard]] bool is_smooth(std::uint32_t triangle, int side) const {
    const std::uint32_t other = across[triangle][side];
    return other != no_index && glm::dot(normals[triangle], normals[other]) >= kWidestCosine;
  }
};

/// O(triangles log triangles at a vertex). \throws Error limit_exceeded as CornerTable does.
[[nodiscard]] SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::lines_detail
