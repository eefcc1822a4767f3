// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen in the order of their ids, sorted into tiles, a bounded batch at a time.
//
// The z-buffer's clusters know no order, so this reads the scene's meshes themselves. Vertices go through the same
// transform and clipping, triangles through the same facing as everywhere.
#pragma once

#include <span>
#include <vector>

#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

inline constexpr int kSubmissionTile = 128;  ///< pixels

/// A triangle with its plane of keys: (key[0] + dx * gx) + dy * gy from the first corner, limited to [k_min, k_max].
struct PlacedTriangle {
  TriangleRecord corners;  ///< from the image's top left, area positive
  float gx, gy;            ///< per 1/256 pixel
  float k_min, k_max;
  float primitive_low, primitive_high;  ///< keys of the primitive's whole visible part, of which clipping leaves pieces
};

/// Consecutive triangles of one instance.
struct Piece {
  std::uint32_t instance;
  std::uint32_t begin, end;  ///< within the mesh
  PrimitiveId first;         ///< id of the instance's first triangle
};

/// What is left of a piece on the screen, in order, and for every tile the numbers of those that may touch it.
struct PlacedPiece {
  std::vector<PlacedTriangle> triangles;
  std::vector<std::uint32_t> begin, items;  ///< by tile

  [[nodiscard]] std::span<const std::uint32_t> in_tile(std::size_t tile) const {
    if (triangles.empty()) return {};
    return std::span(items).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
};

/// Tiles of an image, row by row.
struct TileGrid {
  int width, height, across, down;

  explicit TileGrid(const View& view)
      : width(view.width),
        height(view.height),
        across((view.width + kSubmissionTile - 1) / kSubmissionTile),
        down((view.height + kSubmissionTile - 1) / kSubmissionTile) {}
  [[nodiscard]] std::size_t count() const { return std::size_t(across) * std::size_t(down); }
  [[nodiscard]] PixelRect rect(std::size_t tile) const;
};

/// The pieces of primitives [begin, end), in order.
[[nodiscard]] std::vector<Piece> pieces_of(const Surfaces& surfaces, PrimitiveId begin, PrimitiveId end);
/// How many pieces may be placed at once: their lists stay within 256 MiB even where every triangle fills the image.
[[nodiscard]] std::size_t pieces_at_once(const TileGrid& grid);

/// Transforms, clips, culls and bins one piece; reuses the memory of `placed`.
void place(const Surfaces& surfaces, const Piece& piece, const ScreenTransform& transform, const View& view,
           PlacedPiece& placed);

}  // namespace frontmost::zbuffer_detail
