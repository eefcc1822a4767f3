// SPDX-License-Identifier: Apache-2.0
// Batches of triangles in the order of their ids, for drawing in the order of submission, as OpenGL calls it.
//
//    ids         0 1 2 3 4 5 6 7 8 9 ...
//    small       0 1 2   4 5   7 8 9            runs of the columns
//    single            3     6                  large, or clipped
//    drawn       [0 1 2] 3 [4 5] 6 [7 8 9]      in the order of ids, in every tile
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::zbuffer_detail {

/// Primitives [begin, end).
struct PrimitiveRange {
  PrimitiveId begin, end;
};

/// A large triangle, or one of the pieces that clipping leaves of a triangle.
struct SingleTriangle {
  TriangleRecord record;  ///< vertices from the image's top left
  float low, high;        ///< keys of the primitive's whole visible part
};

/// A batch of triangles of any size.
class OrderedBatch {
 public:
  void clear();
  /// Transforms, clips, culls and appends triangles. Their ids must follow the ids appended before.
  void place(const PlaceTarget& target, const WorldTriangles& triangles, PlaceScratch& scratch);
  /// Makes the lists by tile, once all triangles are appended.
  void list_tiles(const View& view);

  /// Appends a triangle that is drawn one by one. Precondition: its area is positive, and ids ascend.
  void append(const SingleTriangle& single) { singles_.push_back(single); }

  [[nodiscard]] const TriangleBatch& small() const { return small_; }
  [[nodiscard]] TriangleBatch& small() { return small_; }
  [[nodiscard]] std::span<const SingleTriangle> singles() const { return singles_; }
  [[nodiscard]] bool is_in(const Tile& tile) const {
    return !small_.in_tile(tile.column(), tile.row()).empty() || !singles_in(tile).empty();
  }
  /// Visits all triangles that may touch a tile, in order of ids: calls visit_runs(runs) for small triangles of the
  /// columns and visit_single(triangle) for singles.
  template <class VisitRuns, class VisitSingle>
  void visit_tile(const Tile& tile, const VisitRuns& visit_runs, const VisitSingle& visit_single) const {
    const std::span<const TileRun> runs = small_.in_tile(tile.column(), tile.row());
    const std::span<const std::uint32_t> singles = singles_in(tile);
    if (singles.empty()) return visit_runs(runs);
    std::size_t next = 0;
    for (TileRun run : runs) {
      for (; next < singles.size() && run.count > 0; ++next) {
        const SingleTriangle& single = singles_[singles[next]];
        const PrimitiveId* const ids = small_.columns().id + run.first;
        const auto before = std::uint16_t(std::lower_bound(ids, ids + run.count, single.record.id) - ids);
        if (before == run.count) break;
        const TileRun part{run.first, before};
        visit_runs(std::span(&part, 1));
        visit_single(single);
        run = {std::uint16_t(run.first + before), std::uint16_t(run.count - before)};
      }
      visit_runs(std::span<const TileRun>(&run, 1));
    }
    for (; next < singles.size(); ++next) visit_single(singles_[singles[next]]);
  }

 private:
  void append_single(const PlaceTarget& target, const ClippedPolygon& polygon, PrimitiveId id);
  [[nodiscard]] std::span<const std::uint32_t> singles_in(const Tile& tile) const {
    if (singles_.empty()) return {};
    return lists_.of(tile.number);
  }

  TriangleBatch small_;
  std::vector<SingleTriangle> singles_;
  TileLists lists_;  // lists of singles_
};

/// The parts of the scene's ranges that lie within `range`, in order.
[[nodiscard]] std::vector<MeshRange> ranges_within(const PlacedScene& placed, const PrimitiveRange& range);
/// Returns how many batches may be placed at once, so that their lists stay within 256 MiB even if every triangle fills
/// the image.
[[nodiscard]] std::size_t batches_at_once(const View& view);

/// Calls draw(tile, batch) for every tile and every batch of `range` that is in the tile. In each tile, batches come in
/// order; several tiles are drawn at the same time.
template <class Draw>
void submit(const Surfaces& surfaces, const View& view, const PrimitiveRange& range, const Execution& execution,
            const Draw& draw) {
  const ScreenTransform transform(view);
  const PlacedScene& scene = placed_scene(surfaces);
  const PlaceTarget target(transform, view, scene.sides.get(), execution.isa);
  const std::vector<MeshRange> ranges = ranges_within(scene, range);
  const std::vector<BatchSource> sources = batch_sources(ranges);
  const std::size_t at_once = batches_at_once(view);
  std::vector<OrderedBatch> batches(std::min(at_once, sources.size()));
  Pool<PlaceScratch> scratches;
  for (std::size_t first = 0; first < sources.size(); first += at_once) {
    const std::size_t count = std::min(at_once, sources.size() - first);
    parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches.borrow([] { return std::make_unique<PlaceScratch>(); });
      for (std::size_t i = begin; i < end; ++i) {
        batches[i].clear();
        for (std::size_t k = sources[first + i].begin; k < sources[first + i].end; ++k)
          batches[i].place(target, world_triangles(scene, ranges[k], execution.isa, *scratch), *scratch);
        batches[i].list_tiles(view);
      }
    });
    parallel_for(execution, Tile::count(view), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t number = begin; number < end; ++number) {
        const Tile tile(number, view);
        for (std::size_t i = 0; i < count; ++i)
          if (batches[i].is_in(tile)) draw(tile, batches[i]);
      }
    });
    report_progress(execution, "visible", double(first + count) / double(sources.size()));
  }
}

}  // namespace frontmost::zbuffer_detail
