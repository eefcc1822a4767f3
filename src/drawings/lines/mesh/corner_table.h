// SPDX-License-Identifier: Apache-2.0
// Which triangles meet at a vertex, and how they lie to each other there.
//
//             .  |  /            A vertex whose triangles lie side by side all around it is "spread": no two of
//              . | /             these can pass through each other. Whether it is asked once for a vertex saves
//         ------ v ------        asking about all pairs of its triangles.
//              / | .
//             /  |  .
#pragma once

#include "geometry/buckets.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// A triangle, and which of its corners.
class Corner {
 public:
  static constexpr std::size_t most_triangles = std::size_t(1) << 30;

  Corner(std::uint32_t triangle, std::uint32_t k) : number_(triangle << 2 | k) {}
  [[nodiscard]] std::uint32_t triangle() const { return number_ >> 2; }
  [[nodiscard]] std::uint32_t k() const { return number_ & 3; }
  /// The vertices after and before it. By shifts, and without glm's own operator: that branches.
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

/// The triangles at a vertex, as they lie to each other.
struct Star {
  /// As many triangles as most vertices have: with more of them nothing is found.
  static constexpr std::size_t most = 16;

  /// Whether every edge at the vertex belongs to two triangles with different third corners that are wound alike.
  bool is_paired;
  /// Whether besides along one of the axes all of them turn the same way, and once around the vertex: seen from there
  /// they lie side by side.
  bool is_spread;
  /// Of what is paired, bit j: the edge to Corner::last() of corner j, whose number is higher, is not plain.
  std::uint16_t asked;
};

/// For the vertices from `begin` to `end`. An edge is plain where both triangles face the same way and the cosine of
/// their angle, in floats, is more than `plain_cosine`.
using StarsKernel = void (*)(const SeenMesh& seen, const CornerTable& table, float plain_cosine, std::size_t begin,
                             std::size_t end, Star* stars);
[[nodiscard]] StarsKernel stars_kernel(Isa isa);

}  // namespace frontmost::lines_detail
