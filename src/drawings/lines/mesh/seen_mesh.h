// SPDX-License-Identifier: Apache-2.0
// A mesh as it is seen: for every triangle what all further steps ask, in sixteen bytes. Which way it faces is exact;
// its normal is rounded, and known to be so. What is not certain in doubles has a mark, and is asked again with exact
// numbers.
#pragma once

#include "lines/mesh/welded_mesh.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// What is asked of a triangle beside its neighbours, in one piece.
struct SeenTriangle {
  /// Of unit length to 2^-22; zero where it takes more than doubles to tell.
  glm::vec3 normal;
  std::uint32_t bits;

  static constexpr int kFacingShift = 15;
  static constexpr std::uint32_t kOpen = 3u << kFacingShift;  ///< in place of facing(): rounding could matter
  [[nodiscard]] bool is_open() const { return bits >= kOpen; }
  /// Sight::facing()
  [[nodiscard]] int facing() const { return int(bits >> kFacingShift) - 1; }
  /// Bit i: seen along axis i it turns left (i = 0 to 2) or right (3 to 5), whatever rounding does. 0 for nothing
  /// known.
  [[nodiscard]] std::uint32_t turns() const { return bits & 63; }
  /// Bit i: seen along axis i, whoever goes round the corner passes from below it to above in this triangle. Of use
  /// where it turns.
  [[nodiscard]] std::uint32_t climbs(std::uint32_t corner) const { return bits >> (6 + 3 * corner) & 7; }
};

/// A mesh, and by triangle what all steps ask of it.
struct SeenMesh {
  const WeldedMesh& mesh;
  Buffer<std::int8_t> facing;  ///< Sight::facing()
  Buffer<SeenTriangle> triangles;
};

/// O(triangles).
[[nodiscard]] SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution);

/// Rounded, and twice as long as the triangle is large.
[[nodiscard]] inline glm::dvec3 normal_of(const WeldedMesh& mesh, std::uint32_t triangle) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 at = mesh.positions[t.x];
  return glm::cross(mesh.positions[t.y] - at, mesh.positions[t.z] - at);
}

}  // namespace frontmost::lines_detail
