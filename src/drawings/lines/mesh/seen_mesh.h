// SPDX-License-Identifier: Apache-2.0
// A mesh in a view: sixteen bytes for every triangle, with what all further steps need. The facing is exact; the normal
// is rounded. A value that is not certain in doubles is marked and computed again with exact numbers.
#pragma once

#include "lines/mesh/welded_mesh.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// The properties of a triangle that need no neighbours.
struct SeenTriangle {
  /// The unit normal to 2^-22; zero where doubles are not precise enough.
  glm::vec3 normal;
  std::uint32_t bits;

  static constexpr int kFacingShift = 15;
  static constexpr std::uint32_t kOpen = 3u << kFacingShift;  ///< facing() is unknown because of rounding
  [[nodiscard]] bool is_open() const { return bits >= kOpen; }
  /// Sight::facing()
  [[nodiscard]] int facing() const { return int(bits >> kFacingShift) - 1; }
  /// Bit i: seen along axis i, the triangle certainly turns left (i = 0 to 2) or right (i = 3 to 5). 0 if nothing is
  /// known.
  [[nodiscard]] std::uint32_t turns() const { return bits & 63; }
  /// Bit i: seen along axis i, a walk around the corner passes in this triangle from below the corner to above it.
  /// Valid where the triangle turns.
  [[nodiscard]] std::uint32_t climbs(std::uint32_t corner) const { return bits >> (6 + 3 * corner) & 7; }
};

/// A mesh, and its triangles' properties in a view.
struct SeenMesh {
  const WeldedMesh& mesh;
  Buffer<std::int8_t> facing;  ///< Sight::facing()
  Buffer<SeenTriangle> triangles;
};

/// O(triangles).
[[nodiscard]] SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution);

/// The rounded normal; its length is twice the triangle's area.
[[nodiscard]] inline glm::dvec3 normal_of(const WeldedMesh& mesh, std::uint32_t triangle) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 at = mesh.positions[t.x];
  return glm::cross(mesh.positions[t.y] - at, mesh.positions[t.z] - at);
}

}  // namespace frontmost::lines_detail
