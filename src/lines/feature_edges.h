// SPDX-License-Identifier: Apache-2.0
// Which edges of a mesh are drawn.
#pragma once

#include "frontmost/lines.h"
#include "lines/welded_mesh.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// `from` and `to` are vertices, the lower first; `left` and `right` triangles, or no_index.
struct FeatureEdge {
  std::uint32_t from, to, left, right;
  EdgeKind kind;
};

/// `facing` of every triangle as Sight::facing() says. In the order of their vertices. O(triangles).
[[nodiscard]] std::vector<FeatureEdge> find_features(const WeldedMesh& mesh, const std::vector<std::int8_t>& facing,
                                                     const Surfaces& surfaces, const LineOptions& options);

}  // namespace frontmost::lines_detail
