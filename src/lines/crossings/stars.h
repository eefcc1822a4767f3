// SPDX-License-Identifier: Apache-2.0
// The triangles at a vertex, as they lie to each other.
#pragma once

#include "lines/mesh/corner_table.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

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
