// SPDX-License-Identifier: Apache-2.0
// Triangles beside triangles, and the normals of the surfaces that they are cut from.
//
// Files wind neighbours against each other and hold copies of triangles. So a TurnedTriangle says whether a triangle is
// reversed: then it is wound like the neighbour from which it was reached. Slivers, whose corners lie almost on one
// line, have meaningless normals; they take the normal of a neighbour.
#pragma once

#include <array>

#include "lines/mesh/corner_table.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// A triangle seen from a neighbour: reversed where the two are wound against each other.
struct TurnedTriangle {
  std::uint32_t number = no_index;
  bool is_turned = false;

  [[nodiscard]] bool is_there() const { return number != no_index; }
};

/// Whether the triangle's winding runs from vertex a to vertex b, and not from b to a.
[[nodiscard]] inline bool runs(const glm::uvec3& triangle, std::uint32_t a, std::uint32_t b) {
  return (triangle.x == a && triangle.y == b) || (triangle.y == a && triangle.z == b) ||
         (triangle.z == a && triangle.x == b);
}
/// The triangle's corner that is neither a nor b.
[[nodiscard]] inline std::uint32_t third_of(const glm::uvec3& triangle, std::uint32_t a, std::uint32_t b) {
  if (triangle.x != a && triangle.x != b) return triangle.x;
  return triangle.y != a && triangle.y != b ? triangle.y : triangle.z;
}

/// The triangles around a vertex, for walking around it.
class Fan {
 public:
  static constexpr std::size_t most = 32;  ///< triangles; a vertex with more has an empty fan

  struct Side {
    TurnedTriangle triangle;
    std::uint32_t rim;  ///< the vertex at the other end of this side
    std::size_t entry;  ///< the triangle's index in the fan
  };
  /// The side from the fan's vertex to `rim`, of a triangle in the fan.
  [[nodiscard]] Side side(const TurnedTriangle& triangle, std::uint32_t rim) const;
  /// The triangle beyond a side, with its other side at the vertex. Copies of a triangle count once. Returns none where
  /// several different triangles lie beyond.
  [[nodiscard]] Side beyond(const Side& side) const;

 private:
  friend class Neighbours;
  struct Entry {
    std::uint32_t triangle, next, last;
  };
  [[nodiscard]] Side to(std::size_t entry, const Side& from) const;
  [[nodiscard]] Side beyond_copies(const Side& side, std::uint32_t beside) const;

  std::array<Entry, most> entries_;
  std::size_t count_ = 0;
};

class Neighbours {
 public:
  /// O(triangles).
  Neighbours(const SeenMesh& seen, const CornerTable& table, const Execution& execution);

  [[nodiscard]] const glm::uvec3& corners(std::uint32_t triangle) const { return seen_.mesh.triangles[triangle]; }
  [[nodiscard]] glm::dvec3 place(std::uint32_t vertex) const { return seen_.mesh.positions[vertex]; }

  /// The triangle beyond the side from vertex a to vertex b. Copies of a triangle count once. Returns none where
  /// several different triangles lie beyond. O(triangles at a).
  [[nodiscard]] TurnedTriangle beyond(const TurnedTriangle& triangle, std::uint32_t a, std::uint32_t b) const;

  /// O(triangles at the vertex).
  [[nodiscard]] Fan fan(std::uint32_t vertex) const;

  /// The triangle's own normal, of unit length or zero.
  [[nodiscard]] glm::dvec3 normal(const TurnedTriangle& triangle) const {
    const glm::vec3& kept = seen_.triangles[triangle.number].normal;
    const glm::dvec3 normal = kept == glm::vec3(0) ? rounded_normal(triangle.number) : glm::dvec3(kept);
    return triangle.is_turned ? -normal : normal;
  }
  /// Whether the corners lie almost on a line, one between the others. On a curved surface such a triangle may have any
  /// normal: on a chord of a cylinder's rim it lies in the rim's plane.
  [[nodiscard]] bool is_sliver(std::uint32_t triangle) const { return is_sliver_[triangle] != 0; }
  /// The normal of the surface that the triangle is cut from. A sliver that is not part of something wider takes the
  /// normal of one of its neighbours: the one nearest to its own.
  [[nodiscard]] glm::dvec3 surface_normal(const TurnedTriangle& triangle) const;

 private:
  [[nodiscard]] bool find_sliver(std::uint32_t triangle) const;
  [[nodiscard]] glm::dvec3 rounded_normal(std::uint32_t triangle) const;

  const SeenMesh& seen_;
  const CornerTable& table_;
  Buffer<std::uint8_t> is_sliver_;  ///< by triangle
};

}  // namespace frontmost::lines_detail
