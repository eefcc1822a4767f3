// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen in the order of their ids, sorted into tiles, a bounded batch at a time.
//
// The z-buffer's clusters know no order, so this reads the scene's meshes themselves. Vertices go through the same
// transform and clipping, triangles through the same facing as everywhere.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "surfaces/placed_scene.h"
#include "zbuffer/place_kernel.h"

namespace frontmost::zbuffer_detail {

/// Primitives [begin, end).
struct PrimitiveRange {
  PrimitiveId begin, end;
};

/// What placing needs of memory, one a thread.
struct PlaceScratch : WorldScratch {
  PieceVertices vertices;
};

/// What of the scene's ranges lies within `range`, in order.
[[nodiscard]] std::vector<MeshRange> ranges_within(const PlacedScene& placed, const PrimitiveRange& range);
/// How many pieces may be placed at once: their lists stay within 256 MiB even where every triangle fills the image.
[[nodiscard]] std::size_t pieces_at_once(const TileGrid& grid);

/// Transforms, clips, culls and bins one piece; reuses the memory of `piece`.
void place(const WorldTriangles& triangles, const PlaceTarget& target, PieceVertices& vertices, PlacedPiece& piece);

/// Calls draw(tile, piece) for every tile and every piece of the range that is on the screen. In each tile pieces come
/// in order; different tiles are drawn at the same time.
template <class Draw>
void submit(const Surfaces& surfaces, const View& view, const PrimitiveRange& range, const Execution& execution,
            const Draw& draw) {
  const ScreenTransform transform(view);
  const PlaceTarget target(transform, view, execution.isa);
  const PlacedScene& scene = surfaces.placed();
  const std::vector<MeshRange> pieces = ranges_within(scene, range);
  const std::size_t at_once = pieces_at_once(target.grid);
  std::vector<PlacedPiece> placed(std::min(at_once, pieces.size()));
  Pool<PlaceScratch> scratches;
  for (std::size_t first = 0; first < pieces.size(); first += at_once) {
    const std::size_t count = std::min(at_once, pieces.size() - first);
    parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches.borrow([] { return std::make_unique<PlaceScratch>(); });
      for (std::size_t i = begin; i < end; ++i)
        place(world_triangles(scene, pieces[first + i], *scratch), target, scratch->vertices, placed[i]);
    });
    parallel_for(execution, target.grid.count(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile)
        for (std::size_t i = 0; i < count; ++i)
          if (!placed[i].in_tile(tile).empty()) draw(tile, placed[i]);
    });
    report_progress(execution, "visible", double(first + count) / double(pieces.size()));
  }
}

}  // namespace frontmost::zbuffer_detail
