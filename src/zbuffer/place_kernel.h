// SPDX-License-Identifier: Apache-2.0
// Triangles in the order of submission, put on the screen many at a time.
#pragma once

#include <span>

#include "view/screen_transform.h"
#include "zbuffer/placed_triangles.h"

namespace frontmost::zbuffer_detail {

/// Consecutive triangles of one instance.
struct PieceGeometry {
  std::span<const glm::vec3> positions;  ///< world space
  std::span<const glm::uvec3> corners;   ///< numbers of positions
  std::uint32_t first_position = 0;      ///< the number of positions[0]
  bool is_mirrored = false;              ///< the last two corners change places
  PrimitiveId first_id = 0;

  [[nodiscard]] std::array<glm::vec3, 3> world(std::size_t triangle) const {
    const glm::uvec3& c = corners[triangle];
    std::array<glm::vec3, 3> world{positions[c.x - first_position], positions[c.y - first_position],
                                   positions[c.z - first_position]};
    if (is_mirrored) std::swap(world[1], world[2]);
    return world;
  }
};

/// The vertices of a piece on the screen.
struct PieceVertices {
  std::vector<std::int32_t> x, y;  ///< from the image's top left
  std::vector<float> key;          ///< less than 0 where the vertex cannot be snapped as it is

  void make_room(std::size_t count) {
    if (x.size() >= count) return;
    x.resize(count);
    y.resize(count);
    key.resize(count);
  }
};

/// The least and the greatest.
struct NumberRange {
  std::uint32_t low, high;

  /// Whether vertices of so many triangles are best read from the one to the other, as in files whose order is not
  /// random.
  [[nodiscard]] bool is_dense(std::size_t triangle_count) const { return high - low < 6 * triangle_count; }
};
/// Precondition: not empty.
[[nodiscard]] NumberRange range_of_numbers(std::span<const glm::uvec3> corners, Isa isa);

/// Where the vertices of a piece are.
struct PieceExtent {
  bool all_plain = true;       ///< all can be snapped as they are; else the next three mean nothing
  glm::ivec2 low{0}, high{0};  ///< on the screen
  std::int32_t nearest = 0;    ///< bits of the greatest key
  std::int32_t common = -1;    ///< bits that all keys have in common
};

/// What all pieces of a draw call have in common.
struct PlaceTarget {
  const ScreenTransform& transform;
  const View& view;
  TileGrid grid;
  glm::ivec2 low, high;  ///< of the sample offsets
  Isa isa;

  PlaceTarget(const ScreenTransform& t, const View& v, Isa i);
};

/// Appends what of the triangles may cover a sample, in order. Those that have to be clipped go through
/// append_clipped().
void place_triangles(const PlaceTarget& target, const PieceGeometry& piece, PieceVertices& scratch,
                     PlacedTriangles& placed);

/// One triangle, cut into up to seven.
void append_clipped(const PlaceTarget& target, const PieceGeometry& piece, std::size_t triangle,
                    PlacedTriangles& placed);

}  // namespace frontmost::zbuffer_detail
