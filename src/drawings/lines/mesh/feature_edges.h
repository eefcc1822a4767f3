// SPDX-License-Identifier: Apache-2.0
// The edges of a mesh that are drawn, except gaps: places where patches of one surface end beside each other, and only
// rounding keeps them apart. Later steps, which find false creases and gaps, only remove edges from the list.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/mesh/mesh.h"

namespace frontmost::lines_detail {

/// `from` and `to` are vertices, the lower first; `left` and `right` are triangles, or no_index.
struct FeatureEdge {
  std::uint32_t from, to, left, right;
  EdgeKind kind;
  std::int8_t outer;  ///< same meaning as SightedEdge::outer
};

using VertexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct Features {
  std::vector<FeatureEdge> edges;    ///< in the order of their vertices
  VertexPairs continued;             ///< pairs of vertices across gaps, from leave_out_gaps()
  std::vector<std::uint32_t> twins;  ///< triangles that repeat the corners of an earlier triangle; ascending
  /// By vertex, Star::is_spread: no two of its triangles meet except in their common corners. 0 or empty: unknown.
  Buffer<std::uint8_t> is_spread;
};

/// Finds the features; `table` is that of the mesh. O(triangles * log(triangles at a vertex)).
[[nodiscard]] Features find_features(const SeenMesh& seen, const CornerTable& table, const Surfaces& surfaces,
                                     const LineOptions& options, const Execution& execution);

/// A triangle at an edge; the edge's lower vertex is known from the context.
struct Side {
  std::uint32_t upper;  ///< the edge's other vertex
  std::uint32_t triangle;
  std::uint32_t opposite;  ///< the vertex that is not on the edge
  bool is_forward;         ///< the triangle runs from the lower vertex to the upper

  [[nodiscard]] auto key() const { return std::make_tuple(upper, opposite, triangle); }
};

/// Two sides of one edge across which a surface continues.
using SidePair = std::pair<Side, Side>;

using SurfaceOfTriangle = std::function<SurfaceOf(std::uint32_t triangle)>;

/// Pairs the sides of an edge with more than two opposite vertices, so that each pair belongs to one surface. Sides of
/// one object are paired first: two are a pair; a side that occurs as often as all others together is paired with each
/// of them. The sides that remain are then paired with each other by the same rules. `sides` are all sides of one edge,
/// copies included, sorted by opposite vertex; their winding does not matter. O(sides log sides). \returns none if a
/// side has no partner, or more than one possible partner: different surfaces meet at the edge.
[[nodiscard]] std::optional<std::vector<SidePair>> paired_sides(std::span<const Side> sides,
                                                                const SurfaceOfTriangle& surface_of);

/// Whether triangles `a` and `b` lie on opposite sides of a gap. Such triangles pass through each other only because of
/// rounding.
[[nodiscard]] bool meet_at_gap(const WeldedMesh& mesh, const VertexPairs& continued, std::uint32_t a, std::uint32_t b);

/// The cosine of 15 degrees. Smaller folds are never creases, because half the edges of a scanned model are folds of
/// some degrees.
inline constexpr double kLeastFoldCosine = 0.96592582628906831;

/// Removes from `edges` the creases that the surfaces on both sides do not confirm, by hysteresis as in J. Canny. A
/// Computational Approach to Edge Detection. 1986. A strong fold is a crease, and so is a weak fold that continues a
/// strong fold. A triangle with three creases may lose the faintest one. A line of one or two creases that ends in the
/// air is removed, unless it is long; a line may end at a boundary or a border. Silhouettes are judged like creases, so
/// that the result hardly depends on the view, but only creases are removed. The order of the edges stays. O(edges).
void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution);

/// For each edge, 1 if it is a silhouette of a ripple: it bends by less than 34 degrees, and beside it, as seen from
/// the eye, the same surface goes on. The surface counts as the same within two rings of triangles around the edge,
/// where it turns by less than 30 degrees. O(edges).
[[nodiscard]] std::vector<std::uint8_t> find_ripples(const SeenMesh& seen, const CornerTable& table,
                                                     const std::vector<FeatureEdge>& edges, const Execution& execution);

}  // namespace frontmost::lines_detail
