// SPDX-License-Identifier: Apache-2.0
// Draws one tile from batches: the same triangles into the same buffer as tile_kernel.cpp, from another source.
//
// A batch is left out of a tile if its nearest key is hidden in all blocks of the tile that it touches. The batch's
// triangles are read from its columns, in runs. Small triangles are queued like those of clusters; large triangles are
// records and are drawn first.

#include <bit>

#include "zbuffer/direct/direct_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/direct/batch_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/compactor-inl.h"
#include "base/lanes-inl.h"
#include "zbuffer/tile/large_triangles-inl.h"
#include "zbuffer/tile/small_triangles-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes a tile to a VisiblePixels: sample 0 as planes, and the other samples if a pixel's samples differ. Rows are
/// read twice: first to count mixed pixels and reserve their entries of `others`, then to fill these entries. Tiles
/// reserve entries as they come, so the order of `others` depends on threads, but the samples of a pixel do not.
class TilePixels {
 public:
  TilePixels(const Picture& picture, const Tile& tile) : picture_(picture), to_(*picture.pixels), tile_(tile) {}

  void Write(const TileBuffer& buffer) const {
    for (int y = 0; y < tile_.height; ++y) {
      WriteFirst(buffer.Row(0, y), y);
      WriteOthers(buffer, y);
    }
  }

  /// Fills a tile in which nothing is seen.
  void Fill() const {
    for (int y = 0; y < tile_.height; ++y) {
      const std::size_t at = FirstPixel(y);
      std::fill_n(to_.primitives + at, tile_.width, no_primitive);
      std::fill_n(to_.keys + at, tile_.width, 0.0f);
      std::fill_n(to_.mixed + FirstRun(y), RunCount(), std::uint16_t(0));
    }
  }

 private:
  static constexpr int kRun = VisiblePixels::run;
  static_assert(kTileSize % kRun == 0);

  [[nodiscard]] std::size_t FirstPixel(int y) const {
    return std::size_t(tile_.y + y) * std::size_t(picture_.view.width) + std::size_t(tile_.x);
  }
  [[nodiscard]] std::size_t FirstRun(int y) const {
    return std::size_t(tile_.y + y) * to_.runs_across + std::size_t(tile_.x / kRun);
  }
  [[nodiscard]] std::size_t RunCount() const { return std::size_t((tile_.width + kRun - 1) / kRun); }

  void WriteFirst(const std::uint64_t* row, int y) const {
    PrimitiveId* const primitives = to_.primitives + FirstPixel(y);
    float* const keys = to_.keys + FirstPixel(y);
    const auto width = std::size_t(tile_.width);
    std::size_t x = 0;
#if HWY_TARGET != HWY_SCALAR
    for (; x + hn::Lanes(DU()) <= width; x += hn::Lanes(DU())) {
      const RowPart part(row + x);
      hn::StoreU(part.id(), DU(), primitives + x);
      hn::StoreU(part.key(), DF(), keys + x);
    }
#endif
    for (; x < width; ++x) {
      primitives[x] = ~std::uint32_t(row[x]);
      keys[x] = bits_as<float>(std::uint32_t(row[x] >> 32));
    }
  }

  void WriteOthers(const TileBuffer& buffer, int y) const {
    std::uint16_t* const mixed = to_.mixed + FirstRun(y);
    unsigned count = 0;
    for (std::size_t r = 0; r < RunCount(); ++r) {
      mixed[r] = MixedOf(buffer, y, int(r) * kRun);
      count += unsigned(std::popcount(mixed[r]));
    }
    if (count == 0) return;
    const std::size_t samples = picture_.samples.size();
    std::uint32_t place = to_.other_count->fetch_add(count * std::uint32_t(samples - 1));
    for (std::size_t r = 0; r < RunCount(); ++r) {
      to_.places[FirstRun(y) + r] = place;
      ForEachBit(mixed[r], [&](std::size_t bit) {
        for (std::size_t s = 1; s < samples; ++s)
          to_.others[place++] = ~std::uint32_t(buffer.Row(s, y)[r * kRun + bit]);
      });
    }
  }

  /// A bit for each pixel of the run at x whose samples see different primitives.
  [[nodiscard]] HWY_INLINE std::uint16_t MixedOf(const TileBuffer& buffer, int y, int x) const {
    const DU d;
    unsigned bits = 0;
    for (int i = 0; i < kRun; i += int(hn::Lanes(d))) {
      const VU first = RowPart(buffer.Row(0, y) + x + i).id();
      VU different = hn::Zero(d);
      for (std::size_t s = 1; s < picture_.samples.size(); ++s)
        different = hn::Or(different, hn::Xor(RowPart(buffer.Row(s, y) + x + i).id(), first));
      bits |= unsigned(BitsOf(d, hn::Ne(different, hn::Zero(d)))) << i;
    }
    return std::uint16_t(bits);
  }

  const Picture& picture_;
  const PixelPlanes& to_;
  const Tile& tile_;
};

// After this many triangles, the painter decides again whether testing for hidden triangles pays. If so, it updates the
// farthest keys of the blocks. Otherwise, testing pauses for kMostIdle windows.
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

  /// Starts testing for hidden triangles, because the triangles drawn so far hide much of what follows.
  void LookForHidden() {
    idle_ = kMostIdle;
    NextWindow();
  }

  HWY_INLINE void DrawBatch(const TriangleBatch& batch) {
    blocks_ = buffer_.BlocksInTile(batch.rect);
    if (buffer_.AllHide(blocks_, bits_as<float>(batch.nearest))) return;
    const BatchColumns& from = batch.columns();
    const auto append = [&](std::size_t count, const auto& fetch) HWY_ATTR { Append(count, fetch, from); };
    for (const TileRun& run : batch.in_tile(job_.column(), job_.row())) reader_.Read(run, append);
    reader_.Finish(append);
    // Triangles that wait in the queue lie within the batch's blocks, so these marks hold for them, too.
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

  /// Appends triangles to the queue. store(vector, column) writes one column of them.
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
  std::uint64_t blocks_ = 0;  // blocks of the tile that the batch touches
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
