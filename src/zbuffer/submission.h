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
#include "surfaces/cluster_set.h"
#include "zbuffer/place_kernel.h"

namespace frontmost::zbuffer_detail {

/// Consecutive triangles of one instance.
struct Piece {
  std::uint32_t instance;
  std::uint32_t begin, end;  ///< within the mesh
  PrimitiveId first;         ///< id of the instance's first triangle
};

/// Long to place beside being handed to a thread, and its columns of 104 KiB stay in the second-level cache.
inline constexpr std::uint32_t kPieceTriangles = 2048;

/// Primitives [begin, end).
struct PrimitiveRange {
  PrimitiveId begin, end;
};

/// What placing needs of memory, one a thread.
struct PlaceScratch {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> corners;
  PieceVertices vertices;
};

/// The pieces of a range, in order, none of more than `most` triangles. `first_primitives`: by instance.
[[nodiscard]] std::vector<Piece> pieces_of(const Scene& scene, std::span<const PrimitiveId> first_primitives,
                                           const PrimitiveRange& range, std::uint32_t most);
[[nodiscard]] inline std::span<const glm::uvec3> corners_of(const Scene& scene, const Piece& piece) {
  return std::span(scene.meshes[scene.instances[piece.instance].mesh].triangles)
      .subspan(piece.begin, piece.end - piece.begin);
}
/// The triangles of a piece in world space; `numbers` are the least and the greatest of their corners.
[[nodiscard]] PieceGeometry geometry_of(const Scene& scene, const Piece& piece, const NumberRange& numbers,
                                        PlaceScratch& scratch);
/// How many pieces may be placed at once: their lists stay within 256 MiB even where every triangle fills the image.
[[nodiscard]] std::size_t pieces_at_once(const TileGrid& grid);

/// Transforms, clips, culls and bins one piece; reuses the memory of `placed`.
void place(const Scene& scene, const Piece& piece, const PlaceTarget& target, PlaceScratch& scratch,
           PlacedPiece& placed);

/// Calls draw(tile, piece) for every tile and every piece of the range that is on the screen. In each tile pieces come
/// in order; different tiles are drawn at the same time.
template <class Draw>
void submit(const Surfaces& surfaces, const View& view, const PrimitiveRange& range, const Execution& execution,
            const Draw& draw) {
  const ScreenTransform transform(view);
  const PlaceTarget target(transform, view, execution.isa);
  const std::vector<Piece> pieces =
      pieces_of(surfaces.scene(), surfaces.clusters().first_primitives, range, kPieceTriangles);
  const std::size_t at_once = pieces_at_once(target.grid);
  std::vector<PlacedPiece> placed(std::min(at_once, pieces.size()));
  Pool<PlaceScratch> scratches;
  for (std::size_t first = 0; first < pieces.size(); first += at_once) {
    const std::size_t count = std::min(at_once, pieces.size() - first);
    parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches.borrow([] { return std::make_unique<PlaceScratch>(); });
      for (std::size_t i = begin; i < end; ++i) place(surfaces.scene(), pieces[first + i], target, *scratch, placed[i]);
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
