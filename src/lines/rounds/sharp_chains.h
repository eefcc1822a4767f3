// SPDX-License-Identifier: Apache-2.0
// The edges of a mesh that are not smooth, one after the other.
#pragma once

#include <vector>

#include "lines/rounds/smooth_mesh.h"

namespace frontmost::lines_detail {

/// An edge and the triangles at it; `right` may be no_index.
struct SharpEdge {
  std::uint32_t from, to, left, right;
};

struct SharpChain {
  std::vector<std::uint32_t> vertices;  ///< of a closed one the first comes once
  std::vector<std::uint32_t> edges;     ///< the i-th goes from the i-th vertex to the next
  bool is_closed = false;
};

struct SharpChains {
  std::vector<SharpEdge> edges;
  std::vector<SharpChain> chains;
};

inline constexpr std::size_t kFewestSides = 4;  ///< of an arc

/// Each edge is in one chain, but for those of chains that are shorter than an arc. Where several meet, those go on in
/// each other that turn least, and none by more than kWidestStep. O(edges log edges at a vertex).
[[nodiscard]] SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution);

}  // namespace frontmost::lines_detail
