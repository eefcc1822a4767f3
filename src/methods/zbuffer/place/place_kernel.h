// SPDX-License-Identifier: Apache-2.0
// The stage between a scene's triangles and their pixels. Vertices are snapped; triangles are culled, oriented and put
// into the columns of a batch, a vector of triangles at a time. All drawing of batches begins with this stage.
//
//   triangles of the scene
//     -> snap_vertices()      every vertex once
//     -> place_triangles()    small triangles into the batch, the numbers of the others into `apart`
//     -> polygon_of()         one of the others, clipped if needed
#pragma once

#include <span>
#include <vector>

#include "surfaces/placed_scene.h"
#include "view/clip.h"
#include "view/screen_transform.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::zbuffer_detail {

/// Mask of out codes: set bits in the key of a vertex that cannot be snapped, a negative float, name the planes of the
/// clip volume that the vertex is certainly outside of. A triangle is not seen if all its vertices share a bit.
inline constexpr std::int32_t kOutside = 63;

/// Vertices on the screen, and their bounds.
struct SnappedVertices {
  std::vector<std::int32_t> x, y;  ///< from the image's top left
  std::vector<float> key;          ///< less than 0 if the vertex cannot be snapped as it is

  bool all_plain = true;       ///< every vertex can be snapped as it is; if false, the next three mean nothing
  glm::ivec2 low{0}, high{0};  ///< bounds on the screen
  std::int32_t nearest = 0;    ///< bits of the greatest key
  std::int32_t common = -1;    ///< bits that all keys have in common

  void make_room(std::size_t count) {
    if (x.size() >= count) return;
    x.resize(count);
    y.resize(count);
    key.resize(count);
  }
};

/// Memory for placing, one a thread.
struct PlaceScratch : WorldScratch {
  SnappedVertices vertices;
  std::vector<std::uint32_t> apart;
};

/// Puts the vertices on the screen.
void snap_vertices(const PlaceTarget& target, std::span<const glm::vec3> positions, SnappedVertices& vertices);

/// Appends triangles that may cover a sample to the batch, in their order. Appends the numbers of triangles that are
/// drawn one by one to `apart`: large ones, and ones that may need clipping. Precondition: the columns have room.
void place_triangles(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                     TriangleBatch& batch, std::vector<std::uint32_t>& apart);

/// One of the triangles, clipped if it cannot be snapped whole. Has no corners if a vertex is not finite.
[[nodiscard]] ClippedPolygon polygon_of(const PlaceTarget& target, const WorldTriangles& triangles,
                                        const SnappedVertices& vertices, std::size_t triangle);

}  // namespace frontmost::zbuffer_detail
