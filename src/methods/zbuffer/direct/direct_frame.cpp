// SPDX-License-Identifier: Apache-2.0
// One picture without clusters. Batches of triangles in the scene's order are placed on the screen, sorted into tiles,
// and drawn, some hundred batches at a time. Visibility is a minimum, so later batches are simply drawn into the
// picture of the earlier ones.
//
// The first batches are the nearest, judging by a few triangles of each. They hide most of the later batches, which are
// then left out as a whole. `farthest` holds the farthest key of the samples of every block of the picture.

#include "zbuffer/direct/direct_frame.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "view/answer.h"
#include "zbuffer/place/triangle_batch.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {
namespace {

// Half a million triangles are placed at once. A large scene starts with fewer, so that triangles hidden by these need
// not be placed.
constexpr std::size_t kBatchesAtOnce = 256, kBatchesAtFirst = 32, kFewBatches = 128;

/// A batch in three parts, by how its triangles are drawn.
struct DirectBatch {
  TriangleBatch small;
  std::optional<TriangleBatch> cutouts;  ///< small triangles that may have holes
  std::vector<TriangleRecord> records;   ///< large triangles and clipped triangles
};

/// The scratch memory of one thread for filling batches.
struct DirectScratch : PlaceScratch {
  Buffer<BatchColumns> spare{1};
};

class DirectFrame {
 public:
  DirectFrame(const PlacedScene& scene, const View& view, const Execution& execution)
      : scene_(scene),
        execution_(execution),
        cutouts_(scene.cutouts.get()),
        transform_(view),
        target_(transform_, view, scene.sides.get(), execution.isa),
        visible_{view, {}, {}},
        is_drawn_(Tile::count(view), 0),
        farthest_(is_drawn_.size() * BlockBounds::count, 0.0f) {}

  Visible draw() {
    survey();
    make_planes();
    draw_all(nullptr);
    return std::move(visible_);
  }

  VisiblePixels draw_pixels() {
    survey();
    if (order_.size() > batches_at_first()) make_planes();  // hold the picture of the first batches for the later ones
    VisiblePixels pixels = undefined_pixels(visible_.view);
    std::atomic<std::uint32_t> other_count{0};
    const PixelPlanes planes{
        pixels.first.primitives.data(), pixels.first.keys.data(), pixels.mixed.data(), pixels.places.data(),
        pixels.others.data(),           pixels.runs_across(),     &other_count};
    draw_all(&planes);
    pixels.other_count = other_count;
    return pixels;
  }

 private:
  [[nodiscard]] std::size_t batches_at_first() const {
    return order_.size() > kFewBatches ? kBatchesAtFirst : kBatchesAtOnce;
  }

  void make_planes() {
    const std::size_t count = visible_.view.sample_count();
    visible_.primitives = Buffer<PrimitiveId>(count);
    visible_.keys = Buffer<float>(count);
  }

  void draw_all(const PixelPlanes* pixels) {
    std::size_t next = 0, at_once = batches_at_first();
    do {
      const std::size_t count = std::min(at_once, order_.size() - next);
      place({order_.data() + next, count});
      next += count;
      draw_placed(pixels, next == order_.size());
      report_progress(execution_, "visible", order_.empty() ? 1 : double(next) / double(order_.size()));
      at_once = kBatchesAtOnce;
    } while (next < order_.size());
  }

  /// Divides triangles into batches, and sorts the batches nearest first, judging by a few triangles of each, by
  /// slices: the exponent and one bit of the fraction of their keys. The far end of a slice is at most 1.5 times as far
  /// as its near end. Finer slices hide no more, and lose the order of the file, which is the order of memory.
  void survey() {
    constexpr std::size_t kGrain = 64;
    sources_ = batch_sources(scene_.ranges);
    order_.resize(sources_.size());
    parallel_for(execution_, order_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        order_[i] = std::uint64_t(~(bits_as<std::uint32_t>(nearest_of(sources_[i])) >> 22)) << 32 | i;
    });
    std::sort(order_.begin(), order_.end());
  }

  /// Returns the greatest key of some triangles of a batch, or 2, more than any key, if a vertex is nearer than the
  /// near plane.
  [[nodiscard]] float nearest_of(const BatchSource& source) const {
    constexpr std::size_t kTriangles = 4;
    float nearest = 0;
    for (std::size_t k = 0; k < kTriangles; ++k) {
      const MeshRange& range =
          scene_.ranges[source.begin + (2 * k + 1) * (source.end - source.begin) / (2 * kTriangles)];
      const std::span<const glm::uvec3> corners = scene_.corners(range);
      const glm::uvec3& triangle = corners[(2 * k + 1) * corners.size() / (2 * kTriangles)];
      const ToWorld world(scene_.scene->instances[range.instance].world_from_mesh);
      const std::vector<glm::vec3>& positions = scene_.mesh(range).positions;
      for (int c = 0; c < 3; ++c) {
        const HomogeneousVertex v = transform(transform_, world(positions[triangle[c]]));
        if (v.d < transform_.near) return 2;
        if (is_plain(transform_, v)) nearest = std::max(nearest, snap(transform_, v).key);
      }
    }
    return nearest;
  }

  /// Returns false if blocks drawn so far hide the bounds of the vertices, or if these bounds are off the screen.
  [[nodiscard]] bool may_be_seen(const SnappedVertices& vertices) const {
    // `common` is negative if all vertices have out codes. Nothing of them is seen if these out codes share a plane.
    if (!vertices.all_plain) return vertices.common >= 0 || (vertices.common & kOutside) == 0;
    const View& view = visible_.view;
    const PixelRect rect =
        common_part({vertices.low.x >> 8, vertices.low.y >> 8, vertices.high.x >> 8, vertices.high.y >> 8},
                    {0, 0, view.width - 1, view.height - 1});
    if (rect.is_empty()) return false;
    const auto nearest = bits_as<float>(vertices.nearest);
    const std::size_t across = Tile::tiles_across(view);
    for (int y = rect.y0 / kBlockSize; y <= rect.y1 / kBlockSize; ++y)
      for (int x = rect.x0 / kBlockSize; x <= rect.x1 / kBlockSize; ++x) {
        const std::size_t tile = std::size_t(y / 8) * across + std::size_t(x / 8);
        if (!(farthest_[tile * BlockBounds::count + std::size_t(y % 8 * 8 + x % 8)] > nearest)) return true;
      }
    return false;
  }

  void place_range(const MeshRange& range, DirectScratch& scratch, DirectBatch& batch) const {
    const WorldTriangles triangles = world_triangles(scene_, range, target_.isa, scratch);
    snap_vertices(target_, triangles.positions, scratch.vertices);
    if (!may_be_seen(scratch.vertices)) return;
    scratch.apart.clear();
    place_triangles(target_, triangles, scratch.vertices, batch.small, scratch.apart);
    for (const std::uint32_t i : scratch.apart)
      append_polygon(target_, polygon_of(target_, triangles, scratch.vertices, i), triangles.first_id + i,
                     batch.records);
  }

  void place(std::span<const std::uint64_t> chosen) {
    if (const std::size_t made = batches_.size(); made < chosen.size()) {
      const Arena side_by_side((chosen.size() - made) * (sizeof(BatchColumns) + Arena::beside));
      batches_.resize(chosen.size());
    }
    parallel_for(execution_, chosen.size(), 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches_.borrow([] { return std::make_unique<DirectScratch>(); });
      for (std::size_t i = begin; i < end; ++i) {
        const BatchSource& source = sources_[std::uint32_t(chosen[i])];
        DirectBatch& batch = batches_[i];
        batch.small.clear();
        batch.records.clear();
        for (std::size_t range = source.begin; range < source.end; ++range)
          place_range(scene_.ranges[range], *scratch, batch);
        if (cutouts_) {
          if (!batch.cutouts) batch.cutouts.emplace();
          batch.cutouts->clear();
          batch.small.extract([&](PrimitiveId id) { return cutouts_->has(id); }, *batch.cutouts);
          list_tiles(*batch.cutouts, *scratch);
        }
        list_tiles(batch.small, *scratch);
      }
    });
    sort_out(chosen.size());
  }

  static void list_tiles(TriangleBatch& batch, DirectScratch& scratch) {
    batch.gather_strewn(scratch.spare);
    batch.list_tiles();
  }

  /// Collects the placed triangles by kind, nearest first.
  void sort_out(std::size_t count) {
    const std::span<const DirectBatch> placed(batches_.data(), count);
    records_.records.clear();
    nearest_first_.clear();
    for (const DirectBatch& batch : placed) {
      records_.records.insert(records_.records.end(), batch.records.begin(), batch.records.end());
      if (batch.small.count > 0) nearest_first_.push_back(&batch.small);
    }
    first_cutout_ = nearest_first_.size();
    for (const DirectBatch& batch : placed)
      if (batch.cutouts && batch.cutouts->count > 0) nearest_first_.push_back(&*batch.cutouts);
    const auto is_nearer = [](const TriangleBatch* a, const TriangleBatch* b) { return a->nearest > b->nearest; };
    const auto first_cutout = nearest_first_.begin() + std::ptrdiff_t(first_cutout_);
    std::sort(nearest_first_.begin(), first_cutout, is_nearer);
    std::sort(first_cutout, nearest_first_.end(), is_nearer);
    records_.plan(visible_.view, cutouts_);
    list_batches();
  }

  void list_batches() {
    const std::size_t across = Tile::tiles_across(visible_.view);
    batch_lists_.make({0, is_drawn_.size()}, nearest_first_.size(), [&](std::size_t i, const auto& add) {
      const TriangleBatch& batch = *nearest_first_[i];
      const TileRect tiles = batch.tiles();
      for (int y = tiles.y0; y <= tiles.y1; ++y)
        for (int x = tiles.x0; x <= tiles.x1; ++x)
          if (!batch.in_tile(x, y).empty()) add(std::size_t(y) * across + std::size_t(x));
    });
  }

  /// Draws the placed batches. If `is_last` is true, no batches follow, so tiles that are still empty are filled.
  void draw_placed(const PixelPlanes* pixels, bool is_last) {
    const View& view = visible_.view;
    // The planes are touched for the first time; zbuffer.cpp explains the threshold.
    const bool streams = view.sample_count() * (sizeof(PrimitiveId) + sizeof(float)) >= std::size_t(32) << 20;
    const Picture picture(visible_, streams, cutouts_, pixels);
    const BatchFrame frame{picture, nearest_first_, records_.records};
    draw_tiles(records_, view, execution_, tile_scratches_, [&](std::size_t tile, TileScratch& scratch) {
      const BatchJob job{TileJob({tile, view}, records_.of(tile), {batch_lists_.of(tile), first_cutout_}),
                         is_drawn_[tile] != 0, is_last, &farthest_[tile * BlockBounds::count]};
      const bool goes_out = is_last && (pixels || !job.is_drawn);
      if (job.is_empty() && !goes_out) return;
      draw_batches(frame, job, scratch, execution_.isa);
      is_drawn_[tile] = 1;
    });
  }

  const PlacedScene& scene_;
  const Execution& execution_;
  const Cutouts* cutouts_;
  ScreenTransform transform_;
  PlaceTarget target_;
  Visible visible_;
  std::vector<std::uint8_t> is_drawn_;  // by tile: 1 if batches were drawn to it
  std::vector<float> farthest_;         // by tile and block: no sample of the block is farther than this key
  std::vector<BatchSource> sources_;
  std::vector<std::uint64_t> order_;  // nearest first; the number of a batch in the low half
  // State of the batches that are placed.
  std::vector<DirectBatch> batches_;
  std::vector<const TriangleBatch*> nearest_first_;  // solid batches, then batches with cutouts from `first_cutout_` on
  std::size_t first_cutout_ = 0;
  RecordLists records_;
  TileLists batch_lists_;
  Pool<DirectScratch> scratches_;
  Pool<TileScratch> tile_scratches_;
};

}  // namespace

Visible draw_directly(const PlacedScene& scene, const View& view, const Execution& execution) {
  return DirectFrame(scene, view, execution).draw();
}

VisiblePixels draw_pixels_directly(const PlacedScene& scene, const View& view, const Execution& execution) {
  return DirectFrame(scene, view, execution).draw_pixels();
}

}  // namespace frontmost::zbuffer_detail
