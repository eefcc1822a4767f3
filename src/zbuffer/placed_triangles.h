// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen in the order of their ids, set apart by corner, and the tiles that they are drawn in.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

inline constexpr int kSubmissionTile = 128;  ///< pixels

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

/// Corners as of a TriangleRecord, from the image's top left, areas positive.
struct PlacedTriangles {
  static constexpr std::size_t slack = 16;  ///< a store may write a whole vector

  std::array<Buffer<std::int32_t>, 3> x, y;
  std::array<Buffer<float>, 3> key;
  Buffer<float> low, high;  ///< keys of the primitive's whole visible part, of which clipping leaves pieces
  Buffer<PrimitiveId> id;
  Buffer<std::uint32_t> tile;  ///< the only one that it may touch; no_index: it may be several
  std::size_t count = 0;

  /// For that many more, and a vector.
  void make_room(std::size_t more);
  void append(const TriangleRecord& record, float key_low, float key_high, std::uint32_t only_tile);
  [[nodiscard]] TriangleRecord record(std::size_t i) const {
    return {{x[0][i], x[1][i], x[2][i]}, {y[0][i], y[1][i], y[2][i]}, {key[0][i], key[1][i], key[2][i]}, id[i]};
  }
};

/// What is left of a piece on the screen, in order, and for every tile the numbers of those that may touch it.
struct PlacedPiece {
  PlacedTriangles triangles;
  std::vector<std::uint32_t> begin, items;  ///< by tile

  [[nodiscard]] std::span<const std::uint32_t> in_tile(std::size_t tile) const {
    if (triangles.count == 0) return {};
    return std::span(items).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
  /// Makes the lists.
  void bin(const TileGrid& grid);
};

}  // namespace frontmost::zbuffer_detail
