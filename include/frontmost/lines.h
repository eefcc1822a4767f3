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
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// Why an edge is drawn. If several reasons hold, the first one counts.
enum class EdgeKind : std::uint8_t {
  boundary,      ///< belongs to one triangle, or to more than two, of which no two continue each other
  silhouette,    ///< one of its triangles faces the eye, the other does not
  border,        ///< its triangles belong to different instances, or have different materials
  crease,        ///< its triangles meet at an angle
  intersection,  ///< not an edge of the mesh: two triangles pass through each other
};
inline constexpr int edge_kind_count = 5;

struct LineOptions {
  /// Radians, 0 to pi: an edge is a crease if the normals of its triangles differ by more, but never if the triangles
  /// are coplanar. None: an edge is a crease if it bends by at least 18 degrees more than half of what each surface
  /// bends by at its next edge; 12 degrees suffice if both surfaces bend evenly and by at most half as much as the
  /// edge, 9 degrees if a crease continues along the edge. Triangles at more than 34 degrees always form a crease,
  /// those at less than 15 never. A crease of one or two edges that ends in the air is dropped, and one of up to nine
  /// that does so at both ends, unless it is longer than a twentieth of the scene's diagonal.
  std::optional<double> crease_angle = std::nullopt;
  /// True: DrawnPart::hidden_by counts surfaces. False: hidden_by is 0 or 1, which takes less time.
  bool counts_hidden = false;
  /// The kinds of edges that are found. Leaving out intersections saves a third to a half of the time.
  bool boundaries = true, silhouettes = true, borders = true, creases = true, intersections = true;
  /// False: silhouettes of ripples are left out. Where a smooth surface is seen nearly edge-on, single triangles of it
  /// face away from the eye; at their edges the surface bends by less than 34 degrees, and beside them the same surface
  /// is seen, within two rings of triangles. Takes about half a microsecond for each silhouette.
  bool ripples = true;
  bool outlines = false;  ///< true: finds DrawnPart::is_outline
};

/// An edge of the scene, between two points of world space.
struct DrawnEdge {
  glm::dvec3 from{0}, to{0};
  EdgeKind kind = EdgeKind::boundary;
  PrimitiveId left = no_primitive, right = no_primitive;  ///< two triangles of the edge; a boundary may have only one
};

/// A part of an edge that is seen, or hidden, from end to end: from + t * (to - from) for t from `begin` to `end`. Each
/// part begins where the one before it ends, to the bit.
struct DrawnPart {
  std::uint32_t edge = 0;
  double begin = 0, end = 1;
  glm::dvec2 from{0}, to{0};    ///< pixels of the view: x right, y down, the first pixel's centre at (0.5, 0.5)
  std::uint32_t hidden_by = 0;  ///< number of surfaces in front, see LineOptions::counts_hidden; 0: seen
  /// True: the part is seen, and bounds the picture of the scene. Its triangles lie on one side (it is a silhouette or
  /// a boundary), and on the other side the scene has no triangle at any depth.
  bool is_outline = false;
};

struct Drawing {
  View view;
  std::vector<DrawnEdge> edges;
  std::vector<DrawnPart> parts;  ///< in the order of their edges; nothing outside the view
};

// The rules of draw_lines():
//
// - Hiding. A triangle hides a point if the line of sight passes through the triangle, its edges included, in front of
//   the point. Signs of determinants of the vertices' floats decide this, without tolerance. An edge is therefore not
//   hidden by its own triangles, nor by others in their planes, and nothing is seen through the seam between two
//   triangles. Only the ends of parts are rounded, to doubles. Triangles between the eye and the near plane hide
//   nothing. Triangles with holes (alpha mode MASK) hide as if they had none. View::culling is ignored.
// - Vertices at one place count as one, which closes open seams of files without shared vertices.
// - Intersections. Two triangles intersect if each has vertices strictly on both sides of the other's plane. An edge
//   is an intersection, too, if it lies in the plane of a triangle between its own two, and is not drawn for another
//   reason. An object that only stands on a surface does not intersect it. Ends of intersections are rounded, so a
//   plane counts as containing an end if rounding leaves that open. Lines of surfaces that cross have no gaps: segments
//   share their ends to the bit.
// - Degenerate triangles, with vertices exactly on one line, are left out. If they fill a T-junction between a long
//   edge and the short edges that meet it, the long edge's triangle counts as split at the vertices on that edge. The
//   seam is then drawn like any other edge, or not at all if the surface continues. An unfilled T-junction is open: its
//   edges are boundaries.
// - Duplicates. A triangle that occurs again, with its vertices in any order, counts once. Two objects, such as a
//   housing and its cover, may share triangles up to an edge and part there; so may two surfaces of one object. Each of
//   the two then continues by itself, and their common edge is drawn once, with the kind that comes first in EdgeKind.
//   So no line is drawn where two objects, each smooth, pass through each other exactly along a common edge.

/// Finds the feature edges of `surfaces` and cuts each into seen and hidden parts. The result is the same to the bit
/// for any number of threads and every instruction set. Near-linear; quadratic within a cell of the screen with
/// `counts_hidden`, or if thousands of edges and triangles lie in one place of the screen, as at a vertex of thousands
/// of slivers: 20,000 take 11 s. (A. Appel. The Notion of Quantitative Invisibility and the Machine Rendering of
/// Solids. 1967.) \throws Error as validate(view) does; bad_argument for an angle out of range; limit_exceeded for more
/// than 2^20 segments of intersections plus 16 per triangle, 2^21 parts plus 4 per edge, or about 20 s of work.
[[nodiscard]] Drawing draw_lines(const Surfaces& surfaces, const View& view, const LineOptions& options = {},
                                 const Execution& execution = {});

/// Draws lines of the same surfaces in one view after another. The drawer keeps shared vertices, adjacency and
/// intersections, which are the same in every view. Memory: 40 bytes a triangle (48 if there are several objects or
/// materials) and 80 a segment of an intersection, and the room of the first drawing, up to 28 MiB. Not for several
/// threads at once.
class LineDrawer {
 public:
  /// Borrows the surfaces, which must outlive the drawer and not change.
  explicit LineDrawer(const Surfaces& surfaces);
  ~LineDrawer();
  LineDrawer(LineDrawer&&) noexcept;
  LineDrawer& operator=(LineDrawer&&) noexcept;
  LineDrawer(const LineDrawer&) = delete;
  LineDrawer& operator=(const LineDrawer&) = delete;

  /// The same drawing, to the bit, as draw_lines(). \throws Error as draw_lines() does.
  [[nodiscard]] Drawing draw(const View& view, const LineOptions& options = {}, const Execution& execution = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Strokes: the parts of a drawing joined into long lines, as a pen draws them.
//
// A drawing has one part for every edge, cut wherever something hides it. A pen that drew parts one by one would be
// lifted at the end of each, and dashes would begin anew at every vertex:
//
//   parts     o--o--o--o--o       o--o
//             |                   |
//             o--o--o             o--o--o
//   strokes   .-----------        .---            two lines, each drawn without a lift of the pen
//             '-----              '-----

struct Stroke;

struct StrokeOptions {
  bool with_hidden = true;  ///< false: hidden parts are left out
  /// Radians, 0 to pi/2: hidden intersections are left out if their surfaces cross at a smaller angle. Where surfaces
  /// nearly coincide, as a bolt in its bore, intersections are many and show only the tessellation.
  double grazing_angle = 0;
  bool by_kind = true;      ///< false: edges of different kinds may share a stroke
  bool by_outline = true;   ///< false: outlines and other lines may share a stroke
  bool by_instance = true;  ///< false: edges of different objects may share a stroke
  /// Pixels, 0.002 to 1: lines closer to each other are drawn once; strokes this close to their beginning are points.
  double apart = 0.002;
  double tolerance = 0.01;  ///< pixels, 0.0001 to 1: greatest distance of a stroke from its parts
  /// Pixels, 0 to 100. Above 0: four or more consecutive parts become an arc if their ends lie within this distance of
  /// a circle, at most 20 degrees apart: polygons of up to 17 sides stay polygons. The arc also stays within this
  /// distance of each part, unless two of the three parts before it and after it are at least half as long.
  double arc_tolerance = 0;
  /// Pixels, 0 to 10000: a shorter stroke is left out if it ends in the air, or joins lines that continue without it.
  /// Pieces of silhouettes and boundaries that close an outline are kept.
  double shortest = 0;
  /// True, for plotters: strokes whose ends meet are joined, and each begins as near as possible to the end of the one
  /// before. False: strokes come in the order of their parts.
  bool nearest_first = false;
  /// Pixels, 0 to 100: ends of two strokes that are at most this far apart are joined; without `nearest_first`, only if
  /// the strokes go on within 30 degrees.
  double joining = 0.01;
  /// Pixels, 0 to 1000: how far ink reaches from strokes of the given class, half the width of their pen; 0 for dashed
  /// strokes. A stroke is left out if its centre line lies in the ink of longer strokes of its class, or of strokes of
  /// a class that is drawn over it, by a pen at least as wide. A stroke shorter than its own pen is wide is left out
  /// only if both rims of its ink lie there, too, because it may close a gap. Empty: none is left out.
  std::function<double(const Stroke&)> ink_reach{};
};

/// A line from point to point, drawn without lifting the pen.
struct Stroke {
  EdgeKind kind = EdgeKind::boundary;  ///< kind of all parts; without by_kind, of the first part
  bool is_hidden = false;
  bool is_outline = false;            ///< whether all parts are outlines; false without by_outline
  std::uint32_t instance = no_index;  ///< instance of all parts; without by_instance, of the first part
  std::uint32_t first = 0, count = 0;
  bool is_closed = false;  ///< the last point is joined to the first one
};

struct Strokes {
  std::vector<glm::dvec2> points;  ///< pixels, as in DrawnPart
  /// Empty if no stroke has arcs. Otherwise one value for each point, for the join from that point to the next: the
  /// tangent of a quarter of the arc's angle, positive from +x towards +y, at most about 1; 0: straight.
  std::vector<double> bulges;
  /// Sorted: hidden strokes first; then by outline, kind and instance.
  std::vector<Stroke> strokes;
  std::size_t covered = 0;  ///< number of strokes left out by StrokeOptions::ink_reach
};

/// Joins parts of one class (seen or hidden, outline, kind, instance) into strokes wherever exactly two of them meet,
/// and, without `nearest_first`, where three to eight meet and two go on within 15 degrees. Every line is drawn once:
/// of coinciding parts, such as edges behind each other in parallel projection, one is kept, and a seen part is
/// preferred to a hidden one. Edges that are seen as points are left out. Near-linear in the parts; more if thousands
/// crowd within a pixel. \throws Error bad_argument for tolerances out of range.
[[nodiscard]] Strokes chain_strokes(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options = {},
                                    const Execution& execution = {});

// Hatching and stippling: the darkness of surfaces, in pen lines and dots on what is seen of them.
//
//    bright      half dark      darker        in shadow
//                /   /   /    / / / / / /     X X X X X X
//                  /   /   /  / / / / / /     X X X X X X
//                /   /   /    / / / / / /     X X X X X X
//
// Each HatchSet is drawn wherever the brightness is below its threshold, so darker places have the lines of several.

/// Brightness of surfaces: the cosine of the angle between normal and light; 0 in shadow, and for surfaces turned away.
/// Both sides of a surface are lit.
///
/// The normal at a vertex is the mean of the object's triangles there whose normals differ from the triangle's own by
/// at most the crease angle, so brightness changes smoothly where no crease is. Normals of the file are ignored.
struct ToneOptions {
  /// Direction towards the light, world space, any length but zero. None: from the upper left in front of the
  /// picture, as the key light of shade().
  std::optional<glm::dvec3> to_light = std::nullopt;
  bool casts_shadows = true;                   ///< false: nothing blocks the light
  double crease_angle = std::numbers::pi / 6;  ///< radians, 0 to pi
};

/// Parallel lines over the picture, drawn where surfaces are dark.
struct HatchSet {
  double angle = std::numbers::pi / 4;  ///< radians, counter-clockwise from +x as seen on the picture
  double spacing = 10;                  ///< pixels between lines, 0.5 to 100000
  double offset = 0;                    ///< pixels, distance of one of the lines from the picture's upper left corner
  double below = 0.5;                   ///< brightness, -1 to 1, below which lines are drawn
  /// Numbers of the scene's materials that are hatched; empty: all.
  std::vector<std::uint32_t> materials{};
};

/// Three sets that give four tones: bare paper where surfaces are bright; lines `spacing` apart where they are half
/// dark; twice as many lines where they are darker; in shadow, other lines that cross these.
[[nodiscard]] std::vector<HatchSet> hatch_sets(double spacing, double angle);

struct HatchOptions {
  std::vector<HatchSet> sets;  ///< at most 16
  ToneOptions tone{};
  double shortest = 0;      ///< pixels, 0 to 1000: shorter lines are left out
  bool by_instance = true;  ///< false: lines continue from object to object
  /// True, for plotters: each line begins near the end of the one before, whatever their sets; lines are sorted by
  /// instance only.
  bool nearest_first = false;
};

/// A piece of a hatch line on one object.
struct HatchLine {
  glm::dvec2 from{0}, to{0};          ///< pixels of the view, as in DrawnPart
  std::uint32_t set = 0;              ///< index into HatchOptions::sets
  std::uint32_t instance = no_index;  ///< no_index without by_instance
};

/// The pieces of hatch lines that lie on visible, dark parts of `surfaces`, sorted by set, then by line, then along the
/// line. Nothing is sampled. The result is the same to the bit for any number of threads and every instruction set.
/// O(segments), one for each triangle and line over it, beside the grids of occluders of draw_lines(). (G. Winkenbach,
/// D. Salesin. Computer-Generated Pen-and-Ink Illustration. 1994; E. Praun, H. Hoppe, M. Webb, A. Finkelstein.
/// Real-Time Hatching. 2001: sets that stay where darker ones are added.) \throws Error as validate(view) does;
/// bad_argument for options out of range; limit_exceeded for more than 2^26 pieces before joining, or lines tested
/// against more than 2^33 boxes and 16,384 for each triangle.
[[nodiscard]] std::vector<HatchLine> hatch(const Surfaces& surfaces, const View& view, const HatchOptions& options,
                                           const Execution& execution = {});

struct StippleOptions {
  double spacing = 4;  ///< pixels between dots where it is darkest, 0.5 to 1000
  ToneOptions tone{};
  bool by_instance = true;     ///< false: dots belong to no object
  bool nearest_first = false;  ///< true: for plotters, as in HatchOptions
};

/// A dot on an object.
struct Stipple {
  glm::dvec2 at{0};                   ///< pixels of the view, as in DrawnPart
  std::uint32_t instance = no_index;  ///< no_index without by_instance
};

/// Dots on visible parts of `surfaces`: none where the brightness is above 0.95, one per square of side length
/// `spacing` in shadow, and in between the more, the darker the surface is. Dots are spread evenly, in a pattern that
/// depends on the picture alone. The same exact signs as in hatch() decide whether a dot is seen and lit. Dots are
/// sorted by row, then from the left. Cost, threads and errors as for hatch(); limit_exceeded if the picture has room
/// for more than 20 million dots. (R. Ulichney. The Void-and-Cluster Method for Dither Array Generation. 1993.)
[[nodiscard]] std::vector<Stipple> stipple(const Surfaces& surfaces, const View& view, const StippleOptions& options,
                                           const Execution& execution = {});

// Sections: a scene cut by a plane, with the faces of the cut and their hatching.
//
//       taken away  |  what is left           seen from the side that is taken away
//                  _|__________
//    viewer       | |          |                +-----------+
//      >          | |    ...   |                |/ / ___ / /|     the face of the cut, hatched
//                 |_|__________|                | / |   | / |     around a hole in it
//                   |                           |/ /|___|/ /|
//                   at                          +-----------+

/// A plane across an axis of world space. For an oblique plane, turn the scene by the transforms of its instances.
struct CuttingPlane {
  Axis towards = Axis::z;  ///< the side that is taken away, from which a viewer looks
  double at = 0;  ///< coordinate of the plane along that axis, not negated for a minus axis; rounded to a float
};

/// The cut of one object.
struct CutFace {
  std::uint32_t instance = no_index;
  std::uint32_t material = no_index;  ///< the material of this face alone, in Section::scene
  /// Closed lines in the plane. Seen from the side that is taken away, they run counter-clockwise around the cut
  /// material and clockwise around holes. Lines cross only if the object intersects itself.
  std::vector<std::vector<glm::vec3>> outlines{};
  double area = 0;             ///< area of the cut without its holes
  std::size_t open_count = 0;  ///< number of lines that a hole of the mesh leaves open; they bound nothing
};

struct Section {
  /// The part of the scene behind the plane. Instances keep their numbers and names; each has its own mesh in world
  /// space. Materials keep their numbers but lose their textures; the materials of the faces come after them.
  Scene scene;
  std::vector<CutFace> faces;  ///< by instance; only objects that the plane cuts
};

// The rules of cut():
//
// - An object that touches the plane from behind is cut; one that touches it from the front is gone. A face in the
//   plane is therefore cut exactly if its object lies behind it.
// - If the triangles of an object are wound alike, everything that its outlines wind around is filled (nonzero rule),
//   otherwise everything that an odd number of outlines goes around. Segments of the cut that occur in both directions
//   cancel. Outlines that cross themselves are filled by triangles that may overlap.
// - Ends closer than a hundred thousandth of the cut's size are joined: T-junctions leave such gaps.

/// Cuts every object by the plane, but for the instances `whole`: those that it meets stay whole, and have no face. The
/// remains of a closed object are closed: triangles that lie exactly in the plane
/// fill the cut, and share their vertices with the cut triangles, to the bit. Normals, texture coordinates and colours
/// of vertices are lost. Triangles with non-finite vertices are left out. O(triangles); the n vertices of a cut take n
/// log n if the cut looks like one of a machine part, n * n for combs and mazes. (G. Meisters. Polygons Have Ears.
/// 1975.) \throws Error bad_argument for a plane that is not finite as a float.
[[nodiscard]] Section cut(const Surfaces& surfaces, const CuttingPlane& plane, const Execution& execution = {},
                          std::span<const std::uint32_t> whole = {});

/// \returns for each instance the number of the style, 0 to 5, that hatches the object in all of these sections; 0 also
/// if the object is not cut. An object's style differs from those of earlier objects that it may touch, judged by boxes
/// around the faces, as far as six styles suffice. Each face is compared with at most 2048 earlier ones.
[[nodiscard]] std::vector<std::uint8_t> hatch_styles(std::span<const Section* const> sections);

struct SectionHatching {
  double spacing = 30;       ///< pixels from line to line
  double solid_spacing = 2;  ///< pixels between lines that leave no paper visible
  double thinnest = 0;       ///< scene units: faces with a smaller mean thickness are solid
};

/// \returns sets for hatch() that hatch the faces of a section. Lines are continuous, at 45 degrees to either side;
/// their spacing is the given one, or 0.7 or 1.4 times that, by `styles` from hatch_styles() (ISO 128-50). Use them
/// with section_tone(), so that faces are hatched wherever they are seen. O(faces).
[[nodiscard]] std::vector<HatchSet> section_hatch_sets(const Section& section, std::span<const std::uint8_t> styles,
                                                       const SectionHatching& options = {});
/// A light in the plane of the cut, without shadows: all of the cut counts as dark.
[[nodiscard]] ToneOptions section_tone(const CuttingPlane& plane);

// Rounds: circles, cylinders and surfaces of revolution behind a scene's triangles, and their centre lines in drawings.
//
//            |
//         .-~|~-.         +-----------------+      A triangle file has polygons in place of circles. Drawings need the
//   - - /- - + - -\ - -   |- - - - - - - - -|- -   circles: a cross over a circle that is seen along its axis, an axis
//       \    |    /       +-----------------+      line where it is seen from the side, and a diameter among the
//         `-~|~-'                                  dimensions.
//            |

enum class RoundKind : std::uint8_t { circle, cylinder, revolved };

/// A circle of sharp edges, a cylinder of smooth triangles, or a smooth surface that is round about an axis.
struct Round {
  RoundKind kind = RoundKind::circle;
  glm::dvec3 from{0}, to{0};           ///< ends of the axis, world space; for a circle, both are its centre
  glm::dvec3 axis{0, 0, 1};            ///< unit length
  double radius = 0;                   ///< radius of the circle through the vertices; of the largest circle if revolved
  double turn = 0;                     ///< radians, at most 2 pi: the part of the circle that exists
  bool is_hollow = false;              ///< cylinders: the material lies outside, as around a bore
  std::uint32_t first = 0, count = 0;  ///< range of Rounds::triangles
  /// Above 0 for a blind hole, which is open at `from` and closed at `to`: the length of its wall, of chamfers and
  /// roundings between the wall and a face before it or a plane floor, and of walls before a groove. A conical or round
  /// bottom does not count. 0 for all other rounds.
  double depth = 0;
};

/// Plane faces about an axis, as of a nut or of a hexagon socket: a regular polygon.
struct Flats {
  glm::dvec3 from{0}, to{0};           ///< ends of the axis, world space
  glm::dvec3 side{1, 0, 0};            ///< normal of one of the faces, unit length
  double width = 0;                    ///< across flats: between opposite faces
  std::uint32_t sides = 6;             ///< 6, or 4: squares only if a circle or cylinder lies about their axis
  std::uint32_t first = 0, count = 0;  ///< range of Rounds::triangles
};

/// An arc of sharp edges, as at a fillet or a rounded corner.
struct CircleArc {
  glm::dvec3 centre{0}, axis{0, 0, 1};  ///< world space; the axis has unit length
  double radius = 0, turn = 0;          ///< radians: the part of the circle that exists
  glm::dvec3 middle{0};                 ///< the middle of the arc
};

struct Rounds {
  std::vector<Round> rounds;
  /// For each round, the triangles with an edge on its circle, or the triangles of its surface; then those of the
  /// flats. Rounds and flats come in order, and the triangles of one ascend.
  std::vector<PrimitiveId> triangles;
  /// Cylinders of 7 to 17 sides with a sharp rim at either end. They count as polygons: nothing is drawn for them.
  std::vector<Round> prisms;
  std::vector<CircleArc> arcs;  ///< circles of which 40 to 160 degrees exist
  std::vector<Flats> flats;     ///< hexagons, whether they are holes or not, and outer squares
};

// The rules of find_rounds():
//
// - Surfaces are smooth where triangles meet at 20 degrees or less, so polygons of 18 or more sides are round, as in
//   chain_strokes(). Vertices may be off by a quarter of the sagitta of an edge, or by the rounding of six digits if
//   that is more.
// - Circles are chains of sharp edges with vertices on a circle.
// - Cylinders grow from two neighbouring triangles over all smooth ones at the same distance from the same axis. A
//   cylinder that begins at a circle may have vertices within its sides, where something else cuts it.
// - Surfaces of revolution are smooth, go all the way round, and have their vertices in rings of 18 or more: tori,
//   domes, cones. Cylinders are separate, and whole spheres, which have no axis of their own, are left out.
// - A hole is blind if the surface beyond one end of its wall lies within its radius, and the surface beyond the other
//   end lies outside of it. Walls of one object, axis and radius that follow each other, as around a groove, are one
//   hole, whose depth reaches from the first wall to the last.
// - Flats are plane faces that meet each other at 60 or 90 degrees in edges along one axis.

/// Finds the circles and cylinders of which at least 160 degrees exist, other surfaces of revolution, arcs of circles,
/// and hexagons and squares of plane faces. The time is near-linear. \throws Error limit_exceeded for more than 2^29
/// triangles.
[[nodiscard]] Rounds find_rounds(const Surfaces& surfaces, const Execution& execution = {});

struct CentreLineOptions {
  bool with_hidden = true;  ///< false: rounds without a seen line have no centre lines
  double overshoot = 30;    ///< pixels, above 0: how far lines reach beyond their round
};

/// A centre line, in pixels of the view, as in DrawnPart.
struct CentreLine {
  glm::dvec2 from{0}, to{0};
  friend bool operator==(const CentreLine&, const CentreLine&) = default;
};

/// Centre lines after ISO 128. Circles and cylinders seen along their axes, and circles in `strokes`, have a cross;
/// circles and cylinders seen from the side have an axis line. Coinciding ones share a cross or an axis line. There are
/// no centre lines in perspective, nor for a circle or cylinder that is seen at an angle, is smaller than a third of
/// the overshoot, or has less than a fifth of its outline drawn. Crosses of small circles overshoot by the radius, at
/// least by a third of `overshoot`. `rounds` are the circles and cylinders of the drawing's surfaces. Lines are sorted
/// by direction, then by position. \throws Error bad_argument for an overshoot out of range.
[[nodiscard]] std::vector<CentreLine> centre_lines_of(const Rounds& rounds, const Drawing& drawing,
                                                      const Strokes& strokes, const CentreLineOptions& options = {});

}  // namespace frontmost
