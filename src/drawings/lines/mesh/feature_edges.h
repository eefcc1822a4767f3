// SPDX-License-Identifier: Apache-2.0
// Which edges of a mesh are drawn, and which are not because they are gaps: where patches of one surface end beside
// each other, and only rounding keeps them apart.
//
//    edge  =  (lower vertex, upper vertex)  +  the triangles on its left and right, or none  +  why it is drawn
//
// Whatever comes later, creases that are none and gaps, takes edges out of this list and never puts one in.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/mesh/seen_mesh.h"
#include "lines/mesh/sheets.h"

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
