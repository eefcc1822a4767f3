// SPDX-License-Identifier: Apache-2.0
// All triangles of a scene over vertices that are shared wherever they coincide, with closed seams; their properties in
// a view; and the triangles at each vertex.
//
//          C                  C         A filler A-M-B has its corners on one line, and no area: it was put there to
//         / .                /|.        close the long side A-B against the two short ones. The filler is removed, and
//        /   .              / | .       the triangle A-B-C beside it is split at M. So every side has one neighbour
//       A--M--B      ->    A--M--B      again, and surfaces continue across it.
#pragma once

#include <limits>

#include "frontmost/scene.h"
#include "geometry/buckets.h"
#include "lines/mesh/stated_edges.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// Vertex positions in world space, stored as floats, which halves the memory traffic.
struct Positions {
  Buffer<glm::vec3> places;

  Positions() = default;
  explicit Positions(Buffer<glm::vec3> its_places) : places(std::move(its_places)) {}
  [[nodiscard]] std::size_t size() const { return places.size(); }
  [[nodiscard]] glm::dvec3 operator[](std::size_t vertex) const { return glm::dvec3(places[vertex]); }
};

/// The object and the material that a triangle belongs to.
struct SurfaceOf {
  std::uint32_t instance, material;
  friend bool operator==(const SurfaceOf&, const SurfaceOf&) = default;
};

struct WeldedMesh {
  Positions positions;
  /// Each has three different vertices, counter-clockwise as seen from the front.
  Buffer<glm::uvec3> triangles;
  Buffer<PrimitiveId> ids;  ///< ids of the triangles
  StatedEdges stated;
  Buffer<SurfaceOf> surfaces;  ///< by primitive id; empty if the scene is one object of one material

  [[nodiscard]] SurfaceOf surface_of(std::uint32_t triangle) const {
    return surfaces.empty() ? SurfaceOf{0, 0} : surfaces[ids[triangle]];
  }
};

/// Welds the triangles of a scene. Triangles with a vertex that is not finite are left out, and triangles with two
/// vertices at one place. Vertices are numbered in the order in which their places first occur. O(triangles).
[[nodiscard]] WeldedMesh weld(const Surfaces& surfaces, const Execution& execution);

/// Removes the triangles whose corners lie exactly on one line (fillers), and splits triangles beside them at the
/// corners on their sides. Pieces come where their triangle was, with its id. A seam that would make more than five
/// times as many triangles stays open, without its fillers. `facing` is of the mesh, for any view. O(triangles) without
/// fillers, else O(triangles log fillers). \returns whether there were fillers; else the mesh is unchanged.
[[nodiscard]] bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution);

/// The properties of a triangle that need no neighbours.
struct SeenTriangle {
  /// Unit normal with an error of at most 2^-22; zero if doubles are not precise enough to find it.
  glm::vec3 normal;
  std::uint32_t bits;

  static constexpr int kFacingShift = 15;
  static constexpr std::uint32_t kOpen = 3u << kFacingShift;  ///< facing() is unknown because of rounding
  [[nodiscard]] bool is_open() const { return bits >= kOpen; }
  /// Sight::facing()
  [[nodiscard]] int facing() const { return int(bits >> kFacingShift) - 1; }
  /// Bit i, for i from 0 to 2: seen along axis i, the triangle certainly turns left. Bit 3 + i: it certainly turns
  /// right.
  [[nodiscard]] std::uint32_t turns() const { return bits & 63; }
  /// Bit i, if the triangle turns: seen along axis i, a walk around the corner passes here from below it to above it.
  [[nodiscard]] std::uint32_t climbs(std::uint32_t corner) const { return bits >> (6 + 3 * corner) & 7; }
};

/// A mesh and the properties of its triangles in a view.
struct SeenMesh {
  const WeldedMesh& mesh;
  Sight sight;
  Buffer<std::int8_t> facing;  ///< Sight::facing()
  Buffer<SeenTriangle> triangles;
};

/// Computes the properties of all triangles. O(triangles).
[[nodiscard]] SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution);

/// The rounded normal; its length is twice the triangle's area.
[[nodiscard]] inline glm::dvec3 normal_of(const WeldedMesh& mesh, std::uint32_t triangle) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 at = mesh.positions[t.x];
  return glm::cross(mesh.positions[t.y] - at, mesh.positions[t.z] - at);
}

/// The vector at unit length; `otherwise` if it has no direction.
[[nodiscard]] inline glm::dvec3 unit_of(const glm::dvec3& v, const glm::dvec3& otherwise = glm::dvec3(0)) {
  const double length = glm::length(v);
  return length > 0 && length < std::numeric_limits<double>::infinity() ? v / length : otherwise;
}

/// Where a linear function from 0 to 1 is 0 that has these values at its ends, with opposite signs. The values may be
/// wrong by rounding; their signs are not.
[[nodiscard]] inline double root_between(const Signed& at_0, const Signed& at_1) {
  const double a = std::abs(at_0.value), b = std::abs(at_1.value);
  return a + b > 0 ? a / (a + b) : 0.5;
}
/// The place at t from 0 to 1 between two others, computed from the nearer one, so that both ends are exact.
[[nodiscard]] inline glm::dvec3 place_between(const glm::dvec3& from, const glm::dvec3& to, double t) {
  return t <= 0.5 ? from + (to - from) * t : to + (from - to) * (1 - t);
}

/// The triangle's corner that is neither a nor b.
[[nodiscard]] inline std::uint32_t third_of(const glm::uvec3& triangle, std::uint32_t a, std::uint32_t b) {
  if (triangle.x != a && triangle.x != b) return triangle.x;
  return triangle.y != a && triangle.y != b ? triangle.y : triangle.z;
}

/// A triangle, and the index of one of its corners.
class Corner {
 public:
  static constexpr std::size_t most_triangles = std::size_t(1) << 30;

  Corner(std::uint32_t triangle, std::uint32_t k) : number_(triangle << 2 | k) {}
  [[nodiscard]] std::uint32_t triangle() const { return number_ >> 2; }
  [[nodiscard]] std::uint32_t k() const { return number_ & 3; }
  /// The vertex after this corner; last(): the vertex before this corner. Both use shifts, because glm's operator[]
  /// branches.
  [[nodiscard]] std::uint32_t next(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[9u >> 2 * k() & 3];
  }
  [[nodiscard]] std::uint32_t last(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[18u >> 2 * k() & 3];
  }

 private:
  std::uint32_t number_;
};

/// For each vertex, the corners of all triangles that have the vertex, in the order of the triangles.
using CornerTable = Buckets<Corner>;

/// Lists the corners at each vertex. O(triangles). \throws Error limit_exceeded for more than Corner::most_triangles.
[[nodiscard]] CornerTable corner_table(const WeldedMesh& mesh, const Execution& execution);

/// The arrangement of the triangles at a vertex.
struct Star {
  /// Nothing is found for a vertex with more triangles than this; such vertices are rare.
  static constexpr std::size_t most = 16;

  /// Whether every edge at the vertex belongs to exactly two triangles, which are wound alike and have different third
  /// corners.
  bool is_paired;
  /// Whether the star is paired and its triangles lie side by side: seen along one of the axes, all of them turn the
  /// same way, and together they go around the vertex once.
  bool is_spread;
  /// Bit j, for paired stars only: the edge to Corner::last() of corner j leads to a higher vertex and is not plain.
  std::uint16_t asked;
};

/// Which edges are plain, that is no features, where both vertices have is_paired.
struct PlainEdges {
  float least_cosine;  ///< the least cosine between the normals of an edge's two triangles, computed in floats
  bool has_borders;    ///< true: an edge between different surfaces is not plain
  bool has_stated;     ///< true: an edge is not plain if its lower vertex is that of a stated edge
};

/// Finds the stars of the vertices from `begin` to `end`. The two triangles of a plain edge also face the same way.
using StarsKernel = void (*)(const SeenMesh& seen, const CornerTable& table, const PlainEdges& plain, std::size_t begin,
                             std::size_t end, Star* stars);
[[nodiscard]] StarsKernel stars_kernel(Isa isa);

}  // namespace frontmost::lines_detail
