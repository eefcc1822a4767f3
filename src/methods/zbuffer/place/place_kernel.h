// SPDX-License-Identifier: Apache-2.0
// The stage between a scene's own triangles and their pixels: vertices are snapped, and triangles are culled, turned
// and put into the columns of a batch, as many at once as the vector holds. Whatever draws batches begins with it.
//
//   triangles of the scene
//     -> snap_vertices()      every vertex once
//     -> place_triangles()    small ones into the batch, the numbers of the others into `apart`
//     -> polygon_of()         one of the others, clipped where it has to be
#pragma once

#include <span>
#include <vector>

#include "surfaces/placed_scene.h"
#include "view/clip.h"
#include "view/screen_transform.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::zbuffer_detail {

/// Set in the key of a vertex that cannot be snapped as it is, a negative float: the planes of the clip volume that it
/// lies outside of for certain. What has one of them at every corner is not seen.
inline constexpr std::int32_t kOutside = 63;

/// Vertices on the screen, and where they are.
struct SnappedVertices {
  std::vector<std::int32_t> x, y;  ///< from the image's top left
  std::vector<float> key;          ///< less than 0 where the vertex cannot be snapped as it is

  bool all_plain = true;       ///< all can be snapped as they are; else the next three mean nothing
  glm::ivec2 low{0}, high{0};  ///< on the screen
  std::int32_t nearest = 0;    ///< bits of the greatest key
  std::int32_t common = -1;    ///< bits that all keys have in common

  void make_room(std::size_t count) {
    if (x.size() >= count) return;
    x.resize(count);
    y.resize(count);
    key.resize(count);
  }
};

/// What placing needs of memory, one a thread.
struct PlaceScratch : WorldScratch {
  SnappedVertices vertices;
  std::vector<std::uint32_t> apart;
};

/// Puts the vertices on the screen.
void snap_vertices(const PlaceTarget& target, std::span<const glm::vec3> positions, SnappedVertices& vertices);

/// Appends to the batch, in their order, the triangles that may cover a sample, and to `apart` the numbers of those
/// that are drawn one by one: large ones, and such as may have to be clipped. Precondition: there is room in the
/// columns.
void place_triangles(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                     TriangleBatch& batch, std::vector<std::uint32_t>& apart);

/// One of the triangles, clipped where it cannot be snapped whole; without corners where one is not finite.
[[nodiscard]] ClippedPolygon polygon_of(const PlaceTarget& target, const WorldTriangles& triangles,
                                        const SnappedVertices& vertices, std::size_t triangle);

}  // namespace frontmost::zbuffer_detail
