// SPDX-License-Identifier: Apache-2.0
// Round shapes in a mesh: circles of sharp edges, cylinders of smooth surfaces, and other surfaces of revolution; and
// hexagons and squares of plane faces.
//
//    sharp edges --chains--> arcs --on one circle--> circles ------+
//                                                                  v
//    smooth neighbours ------------------------------> walls: cylinders that begin at circles, then the others
//    other regions that close around an axis --------> surfaces of revolution
//    plane faces that meet at 60 or 90 degrees ------> flats
//
// A polygon counts as a circle if its steps are alike and its corners lie on one to the precision of the file.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/lines.h"
#include "geometry/edge_neighbours.h"
#include "lines/mesh/mesh.h"

namespace frontmost::lines_detail {

struct Circle3 {
  glm::dvec3 centre, axis;  ///< unit axis; seen from its tip, the circle runs anticlockwise
  double radius;

  /// The angle from point a to point b around the axis, in (-pi, pi].
  [[nodiscard]] double turn_between(const glm::dvec3& a, const glm::dvec3& b) const {
    const glm::dvec3 u = a - centre, v = b - centre;
    return std::atan2(glm::dot(axis, glm::cross(u, v)), glm::dot(u, v) - glm::dot(u, axis) * glm::dot(v, axis));
  }
  /// The approximate distance of a point from the circle: its distance from the circle's plane, or its distance from
  /// the cylinder over the circle, whichever is greater.
  [[nodiscard]] double distance(const glm::dvec3& point) const {
    const glm::dvec3 u = point - centre;
    const double height = glm::dot(u, axis);
    return std::max(std::abs(height), std::abs(glm::length(u - height * axis) - radius));
  }
};

[[nodiscard]] inline std::optional<Circle3> circle_through(const glm::dvec3& a, const glm::dvec3& b,
                                                           const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, normal = glm::cross(u, v);
  const double square = glm::dot(normal, normal);
  if (!(square > 0) || !std::isfinite(square)) return std::nullopt;
  const glm::dvec3 to_centre = glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) / (2 * square);
  const double radius = glm::length(to_centre);
  if (!std::isfinite(radius)) return std::nullopt;
  return Circle3{a + to_centre, normal / std::sqrt(square), radius};
}

/// The distance between the circle and the middle of a chord that spans `step` radians.
[[nodiscard]] inline double sagitta(double radius, double step) { return radius * (1 - std::cos(step / 2)); }

/// A cylinder without ends.
struct Tube {
  glm::dvec3 point, axis;  ///< `point` is on the axis; the axis has unit length
  double radius;

  /// The vector from the axis to the point `at`, perpendicular to the axis.
  [[nodiscard]] glm::dvec3 outwards(const glm::dvec3& at) const {
    const glm::dvec3 u = at - point;
    return u - glm::dot(u, axis) * axis;
  }
};

/// Two unit vectors that are perpendicular to each other and to `axis`.
struct Across {
  glm::dvec3 u, v;
  explicit Across(const glm::dvec3& axis);
};

/// A number by which lines are sorted: lines that nearly coincide have nearly equal keys. The key is the place of the
/// line's nearest point to the origin, along a direction that is parallel to no usual row of holes.
struct AxisKey {
  double key, slack;  ///< `slack`: error of the key

  /// `off`: error of the line's place; `turned`: error of its direction, in radians.
  AxisKey(const glm::dvec3& point, const glm::dvec3& axis, double off, double turned) {
    const double along = glm::dot(point, axis);
    key = glm::dot(point - along * axis, glm::dvec3(0.7236, 0.5257, 0.4472));
    slack = off + turned * std::abs(along);
  }
};

/// 20.01 degrees, as for arcs of strokes: a larger turn is an edge between neighbours, or a corner of a polygon.
inline constexpr double kWidestStep = 0.34924038;
inline constexpr double kWidestCosine = 0.93963;
inline constexpr double kWhole = 2 * std::numbers::pi;  ///< radians of a whole turn

struct SmoothMesh {
  WeldedMesh mesh;
  Buffer<glm::dvec3> normals;  ///< unit length; zero if rounding leaves no direction
  EdgeNeighbours neighbours;
  double noise = 0;  ///< greatest error of a corner's place, as in files with six digits

  [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, int k) const {
    return mesh.positions[mesh.triangles[triangle][k]];
  }
  /// The only other triangle at a side, if it is wound alike; otherwise no_index.
  [[nodiscard]] std::uint32_t across(std::uint32_t triangle, int side) const {
    return neighbours.across(triangle, std::size_t(side));
  }
  [[nodiscard]] bool is_smooth(std::uint32_t triangle, int side) const {
    const std::uint32_t other = across(triangle, side);
    const glm::uvec3& corners = mesh.triangles[triangle];
    return other != no_index && !mesh.stated.are_sharp(corners[side], corners[side == 2 ? 0 : side + 1]) &&
           glm::dot(normals[triangle], normals[other]) >= kWidestCosine;
  }
};

/// Welds a scene and finds neighbours. O(triangles log triangles at a vertex). \throws Error limit_exceeded as
/// EdgeNeighbours does.
[[nodiscard]] SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution);

/// An edge and its triangles; `right` may be no_index.
struct SharpEdge {
  std::uint32_t from, to, left, right;
};

struct SharpChain {
  std::vector<std::uint32_t> vertices;  ///< a closed chain has its first vertex once
  std::vector<std::uint32_t> edges;     ///< edge i goes from vertex i to the next
  bool is_closed = false;
};

struct SharpChains {
  std::vector<SharpEdge> edges;
  std::vector<SharpChain> chains;
};

inline constexpr std::size_t kFewestSides = 4;  ///< the fewest sides of an arc

/// Chains of at least kFewestSides edges. Where several edges meet, the straightest pairs continue each other, unless
/// the cosine of the turn is below `least_cosine`. O(edges log edges at a vertex).
[[nodiscard]] SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution,
                                       double least_cosine = kWidestCosine);

/// A circle, or several arcs of it.
struct FoundCircle {
  struct Arc {
    glm::dvec3 from, to;  ///< the ends, in the circle's orientation
    double turn;          ///< radians, above 0; 2 pi for a whole circle
  };

  Circle3 circle;
  std::vector<Arc> arcs;                 ///< may overlap
  std::vector<std::uint32_t> triangles;  ///< triangles with a side on the circle
};

/// The total angle that the arcs cover, in radians.
[[nodiscard]] double covered(const FoundCircle& circle);

/// The circles of a mesh; arcs of one circle are united. Near-linear in the number of sharp edges.
[[nodiscard]] std::vector<FoundCircle> find_circles(const SmoothMesh& mesh, const Execution& execution);

/// A round with its triangles of the mesh, in place of Rounds::triangles.
struct FoundRound {
  Round round;
  std::vector<std::uint32_t> triangles;
};

/// The cylinders of a mesh, with ascending triangles: first those that begin at circles, in the order of the circles;
/// then those that begin at two smooth neighbours; last those that something cuts between their ends. Each triangle
/// belongs to at most one cylinder. O(triangles log triangles).
[[nodiscard]] std::vector<FoundRound> find_walls(const SmoothMesh& mesh, const std::vector<FoundCircle>& circles,
                                                 const Execution& execution);

/// Sets Round::depth of blind holes, and turns blind holes so that they begin at their open end. Linear in the walls'
/// triangles, with at most 4096 comparisons for each hole; a hole that would need more has no depth.
void find_depths(const SmoothMesh& mesh, const Surfaces& surfaces, std::vector<FoundRound>& walls,
                 const Execution& execution);

/// Flats with their triangles of the mesh, in place of Flats::first.
struct FoundFlats {
  Flats flats;
  std::vector<std::uint32_t> triangles;
};

/// The hexagons of a mesh, and the squares about the axes of rounds. Linear in the triangles; each square is compared
/// with the rounds whose axes have nearly its key.
[[nodiscard]] std::vector<FoundFlats> find_flats(const SmoothMesh& mesh, std::span<const Round> rounds,
                                                 const Execution& execution);

}  // namespace frontmost::lines_detail

namespace frontmost {

/// The drawn length of each round in pixels: visible lines, and hidden ones if `with_hidden`.
[[nodiscard]] std::vector<double> drawn_lengths(const Rounds& rounds, const Drawing& drawing, bool with_hidden);

/// The place of a world point in a parallel view, in pixels.
[[nodiscard]] glm::dvec2 on_screen(const View& view, const glm::dvec3& point);

}  // namespace frontmost
