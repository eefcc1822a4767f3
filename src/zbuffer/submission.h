// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen in the order of their ids, sorted into tiles, a bounded batch at a time.
//
// The z-buffer's clusters know no order, so this reads the scene's meshes themselves. Vertices go through the same
// transform and clipping, triangles through the same facing as everywhere.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/parallel.h"
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

/// Primitives [begin, end).
struct PrimitiveRange {
  PrimitiveId begin, end;
};

/// The pixels of [0, width) x [0, height) that have a sample between a triangle's outermost corners, `low` and `high`
/// being the least and greatest sample offsets. Most triangles smaller than a pixel have none, and cover nothing.
[[nodiscard]] inline PixelRect sampled_rect(const TriangleRecord& r, const glm::ivec2& low, const glm::ivec2& high,
                                            int width, int height) {
  const std::int32_t x_min = std::min(r.x[0], std::min(r.x[1], r.x[2])),
                     x_max = std::max(r.x[0], std::max(r.x[1], r.x[2]));
  const std::int32_t y_min = std::min(r.y[0], std::min(r.y[1], r.y[2])),
                     y_max = std::max(r.y[0], std::max(r.y[1], r.y[2]));
  return {std::max((x_min + 255 - high.x) >> 8, 0), std::max((y_min + 255 - high.y) >> 8, 0),
          std::min((x_max - low.x) >> 8, width - 1), std::min((y_max - low.y) >> 8, height - 1)};
}

/// The pieces of a range, in order.
[[nodiscard]] std::vector<Piece> pieces_of(const Surfaces& surfaces, const PrimitiveRange& range);
/// How many pieces may be placed at once: their lists stay within 256 MiB even where every triangle fills the image.
[[nodiscard]] std::size_t pieces_at_once(const TileGrid& grid);

/// Transforms, clips, culls and bins one piece; reuses the memory of `placed`.
void place(const Surfaces& surfaces, const Piece& piece, const ScreenTransform& transform, const View& view,
           PlacedPiece& placed);

/// Calls draw(tile, piece) for every tile and every piece of the range that is on the screen. In each tile pieces come
/// in order; different tiles are drawn at the same time.
template <class Draw>
void submit(const Surfaces& surfaces, const View& view, const PrimitiveRange& range, const Execution& execution,
            const Draw& draw) {
  const ScreenTransform transform(view);
  const TileGrid grid(view);
  const std::vector<Piece> pieces = pieces_of(surfaces, range);
  const std::size_t at_once = pieces_at_once(grid);
  std::vector<PlacedPiece> placed(std::min(at_once, pieces.size()));
  for (std::size_t first = 0; first < pieces.size(); first += at_once) {
    const std::size_t count = std::min(at_once, pieces.size() - first);
    parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) place(surfaces, pieces[first + i], transform, view, placed[i]);
    });
    parallel_for(execution, grid.count(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile)
        for (std::size_t i = 0; i < count; ++i) draw(tile, placed[i]);
    });
    report_progress(execution, "visible", double(first + count) / double(pieces.size()));
  }
}

}  // namespace frontmost::zbuffer_detail
