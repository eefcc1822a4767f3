// SPDX-License-Identifier: Apache-2.0
// Triangles in the order of submission, put on the screen many at a time.
#pragma once

#include <span>

#include "surfaces/placed_scene.h"
#include "view/screen_transform.h"
#include "zbuffer/placed_triangles.h"

namespace frontmost::zbuffer_detail {

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
void place_triangles(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& scratch,
                     PlacedTriangles& placed);

/// One triangle, cut into up to seven.
void append_clipped(const PlaceTarget& target, const WorldTriangles& piece, std::size_t triangle,
                    PlacedTriangles& placed);

}  // namespace frontmost::zbuffer_detail
