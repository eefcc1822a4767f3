// SPDX-License-Identifier: Apache-2.0
// The edges of a mesh that are drawn, except gaps: places where patches of one surface end beside each other, and only
// rounding keeps them apart.
//
//    edge  =  (lower vertex, upper vertex)  +  the triangles on its left and right, or none  +  why it is drawn
//
// Later steps, which find false creases and gaps, only remove edges from this list.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/mesh/seen_mesh.h"
#include "lines/mesh/sheets.h"

namespace frontmost::lines_detail {

/// `from` and `to` are vertices, the lower first; `left` and `right` are triangles, or no_index.
struct FeatureEdge {
  std::uint32_t from, to, left, right;
  EdgeKind kind;
  std::int8_t outer;  ///< as for SightedEdge::outer
};

using VertexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct Features {
  std::vector<FeatureEdge> edges;    ///< in the order of their vertices
  VertexPairs continued;             ///< result of leave_out_gaps()
  std::vector<std::uint32_t> twins;  ///< ascending: triangles with the same corners as another before them
  /// By vertex, Star::is_spread: no two of its triangles meet except in their common corners. 0 or an empty list means
  /// unknown.
  Buffer<std::uint8_t> is_spread;
};

/// O(triangles log triangles at a vertex).
[[nodiscard]] Features find_features(const SeenMesh& seen, const Surfaces& surfaces, const LineOptions& options,
                                     const Execution& execution);

struct GapOptions {
  double cosine;          ///< least cosine of the angle by which a continuing surface turns
  double widest;          ///< greatest width of a gap, in world space
  std::size_t triangles;  ///< number of triangles of the mesh, copies counted once
  std::function<SurfaceOf(std::uint32_t triangle)> surface_of;
};

/// Removes from `edges` the boundaries across which their surface continues. All along such a boundary lie others of
/// the same object and material, within `widest` and a sixteenth of its length. Their triangles are on the other side,
/// face the same way and are turned by no more than the angle. (Exporters tessellate each face by itself, so rims share
/// no vertices.) Where more than a third of all sides are open there is no surface, and all boundaries stay.
/// \returns pairs of a gap's vertices and those across it, the lower first, ascending. O(boundaries log boundaries); a
/// boundary with more than 64 others beside it stays.
[[nodiscard]] VertexPairs leave_out_gaps(const SeenMesh& seen, const GapOptions& options,
                                         std::vector<FeatureEdge>& edges);

/// Whether two triangles lie on both sides of a gap: such triangles pass through each other only by rounding.
[[nodiscard]] bool meet_at_gap(const WeldedMesh& mesh, const VertexPairs& continued, std::uint32_t a, std::uint32_t b);

}  // namespace frontmost::lines_detail
