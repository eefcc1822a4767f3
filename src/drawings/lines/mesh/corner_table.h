// SPDX-License-Identifier: Apache-2.0
// The triangles that meet at each vertex, and how they lie around it.
//
//             .  |  /            A vertex is "spread" if its triangles lie side by side all around it: no two of these
//              . | /             can pass through each other. One test for each vertex saves tests of all pairs of its
//         ------ v ------        triangles.
//              / | .
//             /  |  .
#pragma once

#include "geometry/buckets.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// A triangle, and the index of one of its corners.
class Corner {
 public:
  static constexpr std::size_t most_triangles = std::size_t(1) << 30;

  Corner(std::uint32_t triangle, std::uint32_t k) : number_(triangle << 2 | k) {}
  [[nodiscard]] std::uint32_t triangle() const { return number_ >> 2; }
  [[nodiscard]] std::uint32_t k() const { return number_ & 3; }
  /// The vertices after and before this corner. Uses shifts, because glm's operator branches.
  [[nodiscard]] std::uint32_t next(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[9u >> 2 * k() & 3];
  }
  [[nodiscard]] std::uint32_t last(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[18u >> 2 * k() & 3];
  }

 private:
  std::uint32_t number_;
};

/// By vertex, the corners of all triangles that have it, in the order of these triangles.
using CornerTable = Buckets<Corner>;

/// O(triangles). \throws Error limit_exceeded for more than Corner::most_triangles.
[[nodiscard]] CornerTable corner_table(const WeldedMesh& mesh, const Execution& execution);

/// The arrangement of the triangles at a vertex.
struct Star {
  /// Most vertices have at most so many triangles; for more, nothing is found.
  static constexpr std::size_t most = 16;

  /// Whether every edge at the vertex belongs to two triangles with different third corners that are wound alike.
  bool is_paired;
  /// Whether the star is paired and, seen along one of the axes, all triangles turn the same way and go once around the
  /// vertex: then they lie side by side.
  bool is_spread;
  /// For paired stars, bit j: the edge to Corner::last() of corner j leads to a higher vertex and is not plain.
  std::uint16_t asked;
};

/// Finds the stars of the vertices from `begin` to `end`. An edge is plain where both triangles face the same way and
/// the cosine of their angle, in floats, is more than `plain_cosine`.
using StarsKernel = void (*)(const SeenMesh& seen, const CornerTable& table, float plain_cosine, std::size_t begin,
                             std::size_t end, Star* stars);
[[nodiscard]] StarsKernel stars_kernel(Isa isa);

}  // namespace frontmost::lines_detail
