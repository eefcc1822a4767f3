// SPDX-License-Identifier: Apache-2.0
// Draws one tile from batches: the same triangles into the same buffer as tile_kernel.cpp, from another source.
//
// A batch is left out of a tile if its nearest key is hidden in all blocks of the tile that it touches. Its triangles
// come from columns, in runs. Small triangles are queued like those of clusters; large ones are records and come first.

#include "zbuffer/direct/direct_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/direct/batch_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/compactor-inl.h"
#include "zbuffer/direct/tile_pixels-inl.h"
#include "zbuffer/place/run_reader-inl.h"
#include "zbuffer/tile/large_triangles-inl.h"
#include "zbuffer/tile/small_triangles-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// After this many triangles, the painter finds again which blocks hide, or whether testing pays.
constexpr std::size_t kWindow = 512;
constexpr int kMostIdle = 7;

class BatchPainter {
 public:
  BatchPainter(const BatchFrame& frame, const BatchJob& job, TileScratch& scratch)
      : frame_(frame),
        job_(job),
        buffer_(frame, job, scratch),
        large_(frame, job, buffer_),
        small_(frame, job, scratch, buffer_, large_) {}

  void Draw() {
    buffer_.Clear();
    if (job_.is_drawn) buffer_.ReadBack(job_.farthest);
    DrawItems(job_.solid);
    if (!job_.cutouts.is_empty()) {
      TileHoles holes(frame_, job_);
      buffer_.MindHoles(holes);
      LookForHidden();
      DrawItems(job_.cutouts);
    }
    if (job_.is_last && frame_.pixels) return TilePixels(frame_, job_).Write(buffer_);
    buffer_.WriteOut();
    if (!job_.is_last) buffer_.FindFarthest(job_.farthest);
  }

 private:
  void DrawItems(const BatchJob::Items& items) {
    large_.DrawAll(frame_.records, items.records);
    for (const std::uint32_t i : items.batches) DrawBatch(*frame_.batches[i]);
    small_.Finish();
  }

  /// Starts testing for hidden triangles: the tile's earlier triangles hide much of the later ones.
  void LookForHidden() {
    idle_ = kMostIdle;
    NextWindow();
  }

  HWY_INLINE void DrawBatch(const TriangleBatch& batch) {
    blocks_ = buffer_.BlocksInTile(batch.rect);
    float nearest;
    std::memcpy(&nearest, &batch.nearest, sizeof nearest);
    if (buffer_.AllHide(blocks_, nearest)) return;
    const BatchColumns& from = batch.columns();
    const auto append = [&](std::size_t count, const auto& fetch) HWY_ATTR { Append(count, fetch, from); };
    for (const TileRun& run : batch.in_tile(job_.column(), job_.row())) reader_.Read(run, append);
    reader_.Finish(append);
    // Queued triangles stay within the batch's blocks, so these marks stay valid until they are drawn.
    buffer_.MarkDrawn(blocks_);
  }

  /// Appends a packet. `fetch` reads a vector of a column.
  template <class Fetch>
  HWY_INLINE void Append(std::size_t count, const Fetch& fetch, const BatchColumns& from) {
    const DI d;
    const DU du;
    const VI left = hn::Set(d, job_.x * kSubPixels), top = hn::Set(d, job_.y * kSubPixels);
    VI x[3], y[3], key[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = hn::Sub(fetch(d, from.x[k]), left);
      y[k] = hn::Sub(fetch(d, from.y[k]), top);
      key[k] = fetch(d, from.key[k]);
    }
    const VU id = fetch(du, from.id);
    TriangleQueue& queue = small_.queue();
    if (asks_) {
      const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(count)));
      const Compactor<DI> compact(hn::AndNot(Hidden(x, y, key), live));
      Put(x, y, key, id, [&](auto v, auto* to) HWY_ATTR { compact.Store(v, to + queue.count); });
      queue.count += compact.count();
      hidden_ += count - compact.count();
    } else {
      Put(x, y, key, id,
          [&](auto v, auto* to) HWY_ATTR { hn::StoreU(v, hn::DFromV<decltype(v)>(), to + queue.count); });
      queue.count += count;
    }
    small_.DrawFull();
    met_ += count;
    if (met_ >= kWindow) NextWindow();
  }

  /// Puts triangles into the queue by `store`.
  template <class Store>
  HWY_INLINE void Put(const VI (&x)[3], const VI (&y)[3], const VI (&key)[3], VU id, const Store& store) {
    TriangleQueue& queue = small_.queue();
    for (int k = 0; k < 3; ++k) {
      store(x[k], queue.x[k]);
      store(y[k], queue.y[k]);
      store(key[k], queue.key[k]);
    }
    store(id, queue.id);
  }

  [[nodiscard]] HWY_INLINE MI Hidden(const VI (&x)[3], const VI (&y)[3], const VI (&key)[3]) const {
    const VF nearest = hn::BitCast(DF(), hn::Max(key[0], hn::Max(key[1], key[2])));
    return buffer_.Hidden(small_.ColumnsOf(RangeOf(x[0], x[1], x[2])), small_.RowsOf(RangeOf(y[0], y[1], y[2])),
                          nearest);
  }

  /// Testing whether triangles are hidden costs an eighth of drawing a dense mesh. Testing goes on as long as it finds
  /// hidden triangles, and is tried again now and then.
  HWY_NOINLINE void NextWindow() {
    const bool pays = asks_ && hidden_ * 8 >= met_;
    idle_ = pays || idle_ == kMostIdle ? 0 : idle_ + 1;
    asks_ = pays || idle_ == 0;
    met_ = hidden_ = 0;
    if (!asks_) return;
    buffer_.MarkDrawn(blocks_);
    buffer_.Refresh();
  }

  const BatchFrame& frame_;
  const BatchJob& job_;
  TileBuffer buffer_;
  LargeTriangles large_;
  SmallTriangles small_;
  RunReader reader_;
  std::uint64_t blocks_ = 0;  // blocks of the batch
  // State of this window: triangles, hidden triangles, and whether hidden triangles are looked for.
  std::size_t met_ = 0, hidden_ = 0;
  bool asks_ = false;
  int idle_ = kMostIdle;  // windows since testing stopped
};

void DrawBatches(const BatchFrame& frame, const BatchJob& job, TileScratch& scratch) {
  if (!job.is_empty() || job.is_drawn)
    BatchPainter(frame, job, scratch).Draw();
  else if (frame.pixels)
    TilePixels(frame, job).Fill();
  else
    FillTile(frame, job);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawBatches);

void draw_batches(const BatchFrame& frame, const BatchJob& job, TileScratch& scratch, Isa isa) {
  kernel_for(DrawBatchesKernels, isa)(frame, job, scratch);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
