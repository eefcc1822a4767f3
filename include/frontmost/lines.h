// SPDX-License-Identifier: Apache-2.0
// Hidden lines: the feature edges of a scene, cut exactly where they go out of sight.
//
//         from                                          to       DrawnEdge: between two points of the world
//          o-----------------o - - - - - - o-------------o
//          begin 0     end 0.4 = begin     0.7          1        DrawnParts: seen, hidden, seen
//                            |  something  |
//                            |  before it  |
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/scene.h"
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

// Strokes: the parts of a drawing put together to long lines, as a pen draws them.
//
// A drawing has a part for every side of a triangle that is drawn, cut wherever something hides it. A pen that drew
// them one by one would be lifted at the end of each, and dashes would begin anew at every corner:
//
//   parts     o--o--o--o--o       o--o
//             |                   |
//             o--o--o             o--o--o
//   strokes   .-----------        .---            two lines, each drawn without a lift of the pen
//             '-----              '-----

struct StrokeOptions {
  bool with_hidden = true;  ///< false: hidden parts are left out
  /// Radians, 0 to pi/2: hidden intersections of surfaces that pass through each other at less are left out. Where one
  /// lies on another of nearly its own shape, as a bolt in a bore, they are many, and nothing but the triangles' own.
  double grazing_angle = 0;
  bool by_kind = true;      ///< false: edges of all kinds may share a stroke
  bool by_outline = true;   ///< false: outlines and other lines may share a stroke
  bool by_instance = true;  ///< false: edges of several objects may share a stroke
  /// Pixels, 0.002 to 1: lines that are less apart count as one, and are drawn once; strokes that stay within this of
  /// where they begin count as points.
  double apart = 0.002;
  double tolerance = 0.01;  ///< pixels, 0.0001 to 1: strokes leave their parts by at most this
  /// Pixels, 0 to 100. Above 0: runs of at least four parts whose corners lie within this of one circle, with at most
  /// 20 degrees between two, become arcs. A polygon of up to 17 sides stays one. Arcs stay within this of their parts,
  /// too, but beside those of which two among the three before and the three after are at least half as long.
  double arc_tolerance = 0;
  /// Pixels, 0 to 10000: shorter strokes are joined to others that they touch, or left out where they end in the air or
  /// lie between lines that go on without them. Pieces of silhouettes and boundaries that close an outline stay.
  double shortest = 0;
  /// Each stroke begins as near as possible to the end of the one before, and goes on with it where they touch: for
  /// plotters. False: strokes come in the order of their parts.
  bool nearest_first = false;
};

/// A line from point to point, without a lift of the pen.
struct Stroke {
  EdgeKind kind = EdgeKind::boundary;  ///< of all its parts, or, without by_kind, of its first one
  bool is_hidden = false;
  bool is_outline = false;            ///< of all its parts; false without by_outline
  std::uint32_t instance = no_index;  ///< of all its parts, or, without by_instance, of its first one
  std::uint32_t first = 0, count = 0;
  bool is_closed = false;  ///< the last point is joined to the first
};

struct Strokes {
  std::vector<glm::dvec2> points;  ///< in pixels, as DrawnPart's
  /// One for each point, of the join that begins there: the tangent of a quarter of the angle that an arc turns
  /// through, positive from +x towards +y; 0: straight. At most about 1. Empty without arcs.
  std::vector<double> bulges;
  /// Hidden ones first; then by outline, kind and instance.
  std::vector<Stroke> strokes;
};

/// Parts of one class (seen or hidden, outline, kind, instance) that meet end to end, where no third one does, become
/// one stroke. Every line is drawn once: of parts that lie on each other, as an edge behind another in parallel
/// projection, one is kept, the seen one before the hidden one. What is seen as a point is left out. Near-linear in the
/// parts; where thousands crowd within a pixel and no grid parts them, with more than that.
/// \throws Error bad_argument for tolerances out of range.
[[nodiscard]] Strokes chain_strokes(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options = {},
                                    const Execution& execution = {});

// Hatching and stippling: how dark surfaces are, in pen lines and dots on what is seen of them.
//
//    bright      half dark      darker        in shadow
//                /   /   /    / / / / / /     X X X X X X
//                  /   /   /  / / / / / /     X X X X X X
//                /   /   /    / / / / / /     X X X X X X
//
// The lines of a HatchSet come where the brightness falls below its threshold, and stay where it is darker still.

/// How bright surfaces are: the cosine of the angle between their normal and the light, 0 in shadow and where they are
/// turned away.
///
/// Normals are the mean of those of all triangles of an object at a vertex that differ from the triangle's own by at
/// most the crease angle, so that brightness changes smoothly wherever no crease is drawn; normals of the model's file
/// do not count. Both sides of a surface are lit.
struct ToneOptions {
  /// Towards the light, in world space, of any length but zero. None: from the upper left and before the picture, as
  /// the key light of shade().
  std::optional<glm::dvec3> to_light = std::nullopt;
  bool casts_shadows = true;                   ///< false: nothing stands in the light
  double crease_angle = std::numbers::pi / 6;  ///< radians, 0 to pi
};

/// Parallel lines over the picture, drawn where surfaces are dark.
struct HatchSet {
  double angle = std::numbers::pi / 4;  ///< radians, from +x counter-clockwise as it is seen
  double spacing = 10;                  ///< pixels from line to line, 0.5 to 100000
  double offset = 0;                    ///< pixels, of one of the lines from the picture's upper left corner
  double below = 0.5;                   ///< where the brightness is less than this, -1 to 1
  /// On triangles of these materials alone, by their numbers in the scene; empty: on all.
  std::vector<std::uint32_t> materials{};
};

/// Four tones of three sets: paper; lines `spacing` apart where it is half dark; as many between them; and crossed by
/// others in shadow.
[[nodiscard]] std::vector<HatchSet> hatch_sets(double spacing, double angle);

struct HatchOptions {
  std::vector<HatchSet> sets;  ///< at most 16
  ToneOptions tone{};
  double shortest = 0;      ///< pixels, 0 to 1000: shorter lines are left out
  bool by_instance = true;  ///< false: lines go on from object to object
  /// Within a set (and instance) each line begins as near as possible to the end of the one before: for plotters.
  bool nearest_first = false;
};

/// A piece of a hatch line that lies on one object.
struct HatchLine {
  glm::dvec2 from{0}, to{0};          ///< in pixels of the view, as DrawnPart's
  std::uint32_t set = 0;              ///< of HatchOptions::sets
  std::uint32_t instance = no_index;  ///< none without by_instance
};

/// The parts of hatch lines that lie on what is seen of `surfaces`, and is dark there.
///
/// Each line of a set stands for a plane through the eye. It meets every triangle that it passes in a segment, which is
/// cut where it goes out of sight as the edges of draw_lines() are, by the same signs; and where it comes into shadow
/// likewise, in the view of the light. Where the brightness crosses HatchSet::below within a triangle is the root of a
/// quadratic equation. So nothing is sampled. Pieces that meet are joined; all lie on their line to the rounding of
/// doubles. By set, then by line, from one end to the other.
/// (G. Winkenbach, D. Salesin. Computer-Generated Pen-and-Ink Illustration. 1994; E. Praun, H. Hoppe, M. Webb,
/// A. Finkelstein. Real-Time Hatching. 2001: sets that stay where darker ones come.)
/// O(segments) beside the grids of occluders that draw_lines() makes too; a triangle has a segment for every line over
/// it. The result is the same to the bit for any number of threads and every instruction set. \throws Error as
/// validate(view) does, bad_argument for options out of range, and limit_exceeded for more than 2^26 pieces, before
/// they are joined, and where lines are held against more than 2^33 boxes and 16,384 for each triangle.
[[nodiscard]] std::vector<HatchLine> hatch(const Surfaces& surfaces, const View& view, const HatchOptions& options,
                                           const Execution& execution = {});

struct StippleOptions {
  double spacing = 4;  ///< pixels between dots where it is darkest, 0.5 to 1000
  ToneOptions tone{};
  bool by_instance = true;     ///< false: dots belong to no object
  bool nearest_first = false;  ///< for plotters, as HatchOptions
};

/// A dot on an object.
struct Stipple {
  glm::dvec2 at{0};                   ///< in pixels of the view, as DrawnPart's
  std::uint32_t instance = no_index;  ///< none without by_instance
};

/// Dots on what is seen of `surfaces`, the more of them the darker it is: none where the brightness is over 0.95, one
/// to a square of `spacing` in shadow. They lie as far from each other as their number allows, in a pattern that
/// depends on the picture alone. Each is seen and in shadow or not by the same signs as hatch(). By row, from the left.
/// (R. Ulichney. The Void-and-Cluster Method for Dither Array Generation. 1993.)
/// Cost, threads and errors as for hatch(); limit_exceeded where the picture has room for more than 20 million dots.
[[nodiscard]] std::vector<Stipple> stipple(const Surfaces& surfaces, const View& view, const StippleOptions& options,
                                           const Execution& execution = {});

// Sections: a scene cut by a plane, with the faces of the cut, and how drafters hatch them.
//
//       taken away  |  what is left           seen from the side that is taken away
//                  _|__________
//    viewer       | |          |                +-----------+
//      >          | |    ...   |                |/ / ___ / /|     the face of the cut, hatched
//                 |_|__________|                | / |   | / |     around a hole in it
//                   |                           |/ /|___|/ /|
//                   at                          +-----------+

/// A plane across an axis of world space. For one at an angle turn the scene: by the transforms of its instances.
struct CuttingPlane {
  Axis towards = Axis::z;  ///< what lies on this side of it is taken away; that is where a viewer stands
  double at = 0;           ///< its coordinate along that axis, also of a minus axis; rounded to a float
};

/// What the plane cuts of one object.
struct CutFace {
  std::uint32_t instance = no_index;
  std::uint32_t material = no_index;  ///< of its triangles and no others, in Section::scene
  /// Closed lines in the plane, without crossings where the object has none: counter-clockwise around what is cut, as
  /// seen from the side that is taken away, clockwise around holes in it.
  std::vector<std::vector<glm::vec3>> outlines{};
  double area = 0;             ///< without the holes
  std::size_t open_count = 0;  ///< lines that do not close, as of meshes with holes: they bound nothing
};

struct Section {
  /// What is left. Instances have the numbers and names that they had, without transforms, each its own mesh with
  /// positions in world space; materials keep their numbers and lose their textures, and those of the faces follow.
  Scene scene;
  std::vector<CutFace> faces;  ///< by instance; none of what the plane misses
};

/// Cuts every object by the plane. Where an object is closed so is what is left of it: the cut is filled with triangles
/// that lie in the plane exactly, between the corners of the cut triangles, the same bits on both sides of an edge.
///
/// What touches the plane from behind counts as cut, what touches it from before is gone, so that a face in the plane
/// is cut just if its object lies behind it. Of an object whose triangles are wound alike, all that its outlines wind
/// around is filled (nonzero rule), of another what an odd number of outlines goes around. Sides that two triangles
/// have in opposite directions are none. Ends that lie nearer to each other than a hundred thousandth of the cut's size
/// are joined: T-junctions leave such gaps. Outlines that cross themselves are filled by triangles that may overlap.
/// Normals, texture coordinates and colours of vertices are not kept. Triangles with a corner that is not finite are
/// left out. O(triangles), and of the corners of each cut n log n where it looks like a part; combs and mazes may take
/// n * n. (G. Meisters. Polygons Have Ears. 1975.) \throws Error bad_argument for a plane that is not finite as a
/// float.
[[nodiscard]] Section cut(const Surfaces& surfaces, const CuttingPlane& plane, const Execution& execution = {});

/// By instance, in which of six ways an object is hatched in all of these sections: another one than the objects before
/// it that it may touch in one of them, as boxes around their faces tell, as far as six are enough. 0 of what is not
/// cut. Each face is held against 2048 before it at most.
[[nodiscard]] std::vector<std::uint8_t> hatch_styles(std::span<const Section* const> sections);

struct SectionHatching {
  double spacing = 30;       ///< pixels from line to line
  double solid_spacing = 2;  ///< pixels: of lines that leave no paper between them
  double thinnest = 0;       ///< in the scene's unit: faces that are thinner on an average are solid
};

/// Sets of hatch() for the faces of a section: continuous lines at 45 degrees to one side or the other, as far apart as
/// said, or 0.7 or 1.4 times that, by the styles of hatch_styles() (ISO 128-50). section_tone() goes with them: faces
/// are hatched wherever they are seen, whatever the light. O(faces).
[[nodiscard]] std::vector<HatchSet> section_hatch_sets(const Section& section, std::span<const std::uint8_t> styles,
                                                       const SectionHatching& options = {});
/// A light in the plane of the cut, without shadows.
[[nodiscard]] ToneOptions section_tone(const CuttingPlane& plane);

// Rounds: the circles, cylinders and surfaces of revolution that a scene's triangles stand for, and their centre lines
// in a drawing.
//
//            |
//         .-~|~-.         +-----------------+
//   - - /- - + - -\ - -   |- - - - - - - - -|- -
//       \    |    /       +-----------------+
//         `-~|~-'
//            |
//
// A file of triangles has a polygon where its maker had a circle. Drawings need the circle: a cross over it when it is
// seen along its axis, an axis when it is seen from the side, and a diameter among the dimensions.

enum class RoundKind : std::uint8_t { circle, cylinder, revolved };

/// A circle of sharp edges, a cylinder of smooth triangles, or all of a smooth surface that is round about an axis.
struct Round {
  RoundKind kind = RoundKind::circle;
  glm::dvec3 from{0}, to{0};           ///< ends of the axis, in world space; of a circle both its centre
  glm::dvec3 axis{0, 0, 1};            ///< of unit length
  double radius = 0;                   ///< of the circle on which the vertices lie; revolved: of the largest
  double turn = 0;                     ///< radians, at most 2 pi: how much of it there is
  bool is_hollow = false;              ///< a cylinder: what it bounds lies outside of it, as of a bore
  std::uint32_t first = 0, count = 0;  ///< in Rounds::triangles
};

struct Rounds {
  std::vector<Round> rounds;
  /// Those with a side on the circle, or of the surface. In the order of the rounds, each's ascending.
  std::vector<PrimitiveId> triangles;
  /// Cylinders of 7 to 17 sides with a sharp rim at either end. They count as polygons: nothing is drawn for them.
  std::vector<Round> prisms;
};

/// The circles and cylinders of a scene of which at least 160 degrees are there, and what else is round about an axis.
///
/// Surfaces are smooth where triangles meet at 20 degrees or less, so that a polygon of 18 sides and more is round, as
/// it is to chain_strokes(). Edges that are not smooth are followed from one to the next; where their corners lie on a
/// circle they are one. A cylinder is grown from two neighbours over all that lie smoothly about the same axis, at the
/// same distance. Corners may be off by a quarter of how far the middle of a side is, or by what six digits leave open
/// where that is more; so nothing is asked of what is not tessellated from something round. From a circle's edge a
/// cylinder may have corners within its sides as well, where something else cuts it. Surfaces of revolution are what is
/// smooth from one triangle to the next, goes all the way round and has its corners in rings of 18 and more: tori,
/// domes, cones; but not cylinders, nor whole spheres, which have no axis of their own. Near-linear. \throws Error
/// limit_exceeded for more than 2^30 triangles.
[[nodiscard]] Rounds find_rounds(const Surfaces& surfaces, const Execution& execution = {});

struct CentreLineOptions {
  bool with_hidden = true;  ///< false: what shows no line that is seen has none
  double overshoot = 30;    ///< pixels, above 0: how far they reach beyond what they are drawn for
};

/// In pixels of the view, as DrawnPart's.
struct CentreLine {
  glm::dvec2 from{0}, to{0};
  friend bool operator==(const CentreLine&, const CentreLine&) = default;
};

/// Centre lines as ISO 128 has them: crosses over circles and cylinders that are seen along their axes, and over what
/// is a circle in `strokes`, one at each place; axes of what is seen from the side, one along each line. None for what
/// is seen at an angle, is smaller than a third of the overshoot, or of which less than a fifth is drawn; nor in
/// perspective. `rounds` are those of the surfaces of the drawing. Small circles have crosses that reach beyond them by
/// their radius alone, but by a third of the overshoot at least. In the order of their directions and places.
/// \throws Error bad_argument for an overshoot out of range.
[[nodiscard]] std::vector<CentreLine> centre_lines_of(const Rounds& rounds, const Drawing& drawing,
                                                      const Strokes& strokes, const CentreLineOptions& options = {});

}  // namespace frontmost
