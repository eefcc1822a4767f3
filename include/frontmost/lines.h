// SPDX-License-Identifier: Apache-2.0
// Hidden lines: the feature edges of a scene, cut exactly where they go out of sight.
//
//         from                                          to       DrawnEdge: between two points of the world
//          o-----------------o - - - - - - o-------------o
//          begin 0     end 0.4 = begin     0.7          1        DrawnParts: seen, hidden, seen
//                            |  something  |
//                            |  before it  |
#pragma once

#include <optional>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"

namespace frontmost {

/// Why an edge is drawn. Where several hold, the first.
enum class EdgeKind : std::uint8_t {
  boundary,      ///< of one triangle alone, or of more than two between which no surface goes on
  silhouette,    ///< one of its triangles faces the eye, the other does not
  border,        ///< its triangles belong to different instances, or have different materials
  crease,        ///< its triangles meet at an angle
  intersection,  ///< no edge of the mesh: where two triangles pass through each other
};
inline constexpr int edge_kind_count = 5;

struct LineOptions {
  /// Radians, 0 to pi: edges whose triangles' normals differ by more are creases. Edges between triangles of one plane
  /// never are. None: a crease is where the surfaces on both sides differ, by 18 degrees or more, once each has been
  /// followed to the edge as it turns beside it; by 12 or more where both turn evenly, and by half as much at most; or
  /// by 9 where a crease goes on along them. Slivers have the normals of their surfaces, triangles that meet at more
  /// than 34 degrees are always creases, and those at less than 15 never. One or two edges that end in the air are none
  /// but where they are longer than a twentieth of all.
  std::optional<double> crease_angle = std::nullopt;
  /// True: DrawnPart::hidden_by counts; false: it tells 0 from more, and costs less.
  bool counts_hidden = false;
  /// Which kinds are found. Without intersections a third to a half of the time is saved.
  bool boundaries = true, silhouettes = true, borders = true, creases = true, intersections = true;
  bool outlines = false;  ///< DrawnPart::is_outline is found
};

/// An edge of the scene, between two points of world space.
struct DrawnEdge {
  glm::dvec3 from{0}, to{0};
  EdgeKind kind = EdgeKind::boundary;
  PrimitiveId left = no_primitive, right = no_primitive;  ///< two of its triangles; a boundary may have one
};

/// A part of an edge that is seen, or hidden, from end to end: from + t * (to - from) for t from `begin` to `end`.
/// Parts of an edge follow each other, and where one ends the next begins, to the bit.
struct DrawnPart {
  std::uint32_t edge = 0;
  double begin = 0, end = 1;
  glm::dvec2 from{0}, to{0};    ///< in pixels of the view: x right, y down, the first pixel's centre at (0.5, 0.5)
  std::uint32_t hidden_by = 0;  ///< surfaces in front of it; 0: seen. Without LineOptions::counts_hidden 0 or 1
  /// It is seen, and beside it nothing is: its own triangles lie on one side of it (they are silhouettes or
  /// boundaries), and on the other there is no triangle of the scene, before it or behind. The other silhouettes are
  /// contours within the scene's picture.
  bool is_outline = false;
};

struct Drawing {
  View view;
  std::vector<DrawnEdge> edges;
  std::vector<DrawnPart> parts;  ///< in the order of their edges; none of what lies outside of the view
};

/// The feature edges of `surfaces`, each cut into seen and hidden parts.
///
/// What hides is decided by the signs of determinants of the vertices' floats, without tolerance: a point is hidden by
/// a triangle when the line of sight to it passes through the triangle, its edges included, before the point. So
/// neither an edge's own triangles nor others of their planes hide it, and nothing is seen through the seam between two
/// triangles. Ends of parts are rounded to doubles. Vertices at one place count as one, so that open seams of files
/// without shared vertices are closed. Triangles between the eye and the near plane hide nothing; those with holes
/// (alpha mode MASK) hide as if they had none. View::culling does not count: triangles hide, and have edges, whichever
/// way they face.
/// An intersection belongs to two triangles each of which has corners strictly on either side of the other's plane, or
/// to an edge that lies in the plane of a triangle between its own two, and is not drawn itself: what only stands on a
/// surface does not pass through it, and draws its own edges. Its ends are rounded, so that a
/// plane counts as holding an end that their rounding leaves open. Surfaces that cross give lines without gaps, end to
/// end to the bit.
/// Near-linear: every edge is held against the triangles in the cells of a screen grid that it passes, all of one size;
/// cells in which many triangles come together are divided into smaller ones. Where edges and triangles lie upon each
/// other all along, as in stacks of which every sheet is seen or around a vertex of thousands of slivers, and with
/// counts, time goes with the square of their number in a cell: a cone of 20,000 slivers takes 11 s.
/// Triangles whose corners lie on one line, exactly, are left out. Where such fill a T-junction, between a long side
/// and the short ones that meet it, the long side's triangle counts as cut at the corners on it: the seam is drawn as
/// any other edges are, once, or not at all where the surface goes on. A T-junction that nothing fills is open, and its
/// sides are boundaries. (A. Appel. The Notion of Quantitative Invisibility and the Machine Rendering of Solids. 1967.)
/// A triangle that is there again, its corners in any order, counts once. Where objects have triangles in common that
/// do not go on with the same ones, as a housing and its cover do, each goes on by itself, and the edge is what it is
/// for that of them for which it comes first by its kind; two of one object may have triangles in common as well. The
/// result is the same to the bit for any number of threads and every instruction set. \throws Error as validate(view)
/// does, bad_argument for an angle that is out of range, and limit_exceeded for more than 2^20 segments of
/// intersections and 16 for each triangle, 2^21 parts and 4 for each edge, or work of about 20 s: many times what a
/// city takes.
[[nodiscard]] Drawing draw_lines(const Surfaces& surfaces, const View& view, const LineOptions& options = {},
                                 const Execution& execution = {});

}  // namespace frontmost
