// SPDX-License-Identifier: Apache-2.0
// Gaps: where patches of one surface end beside each other, and only rounding keeps them apart.
#pragma once

#include <functional>
#include <vector>

#include "lines/mesh/feature_edges.h"
#include "lines/mesh/sheets.h"

namespace frontmost::lines_detail {

struct GapOptions {
  double cosine;          ///< of the angle by which a surface that goes on may turn at most
  double widest;          ///< gap, in world space
  std::size_t triangles;  ///< of the mesh, copies counted once
  std::function<SurfaceOf(std::uint32_t triangle)> surface_of;
};

/// Leaves out of `edges` the boundaries across which their surface goes on: all along them, no farther away than the
/// gap is wide, and than a sixteenth of their length, lie other boundaries of the same object and material, whose
/// triangles are on the other side, face the same way and are turned by no more than the angle. Exporters write the
/// faces of a shape one by one, cut into triangles each for itself, so that their rims share no vertices. Where more
/// than every third side of a triangle is open there is no surface, and all stay. The order of the others stays.
/// \returns the vertices of gaps with those on their other side, the lower first, ascending. O(boundaries log
/// boundaries) but where many lie in one place: what has more than 64 beside it stays.
[[nodiscard]] VertexPairs leave_out_gaps(const SeenMesh& seen, const GapOptions& options,
                                         std::vector<FeatureEdge>& edges);

/// Whether two triangles lie on both sides of a gap: where such two pass through each other, rounding makes them do so.
[[nodiscard]] bool meet_at_gap(const WeldedMesh& mesh, const VertexPairs& continued, std::uint32_t a, std::uint32_t b);

}  // namespace frontmost::lines_detail
