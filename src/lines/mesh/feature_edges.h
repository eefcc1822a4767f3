// SPDX-License-Identifier: Apache-2.0
// Which edges of a mesh are drawn.
#pragma once

#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// `from` and `to` are vertices, the lower first; `left` and `right` triangles, or no_index.
struct FeatureEdge {
  std::uint32_t from, to, left, right;
  EdgeKind kind;
  std::int8_t outer;  ///< as SightedEdge::outer
};

using VertexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct Features {
  std::vector<FeatureEdge> edges;    ///< in the order of their vertices
  VertexPairs continued;             ///< leave_out_gaps()
  std::vector<std::uint32_t> twins;  ///< ascending: triangles with the same corners as another before them
  /// By vertex, Star::is_spread: no two of its triangles meet but in their common corners. 0, or an empty list, where
  /// nothing is known.
  Buffer<std::uint8_t> is_spread;
};

/// O(triangles log triangles at a vertex).
[[nodiscard]] Features find_features(const SeenMesh& seen, const Surfaces& surfaces, const LineOptions& options,
                                     const Execution& execution);

}  // namespace frontmost::lines_detail
