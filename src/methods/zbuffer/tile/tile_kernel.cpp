// SPDX-License-Identifier: Apache-2.0
// Draws one tile: triangles into a private buffer of 64-bit words, many triangles at a time while they are small.
//
// J. Pineda. A Parallel Algorithm for Polygon Rasterization. 1988 (edge functions).
//
// Coordinates are relative to the tile, in 1/256 pixel. A sample is covered if E >= 0 for three edge functions, biased
// by the top-left rule (y down, area positive: an edge is left if it goes up, top if it is level and goes right).
// Pixels are 256 units apart, so an edge value may be shifted right by 8 before stepping: a step is then -dy or dx, and
// the sign is still exact. Every path evaluates keys exactly as view/triangle_keys.h defines them.

#include "zbuffer/frame_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/tile/tile_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "view/snap-inl.h"
#include "zbuffer/tile/large_triangles-inl.h"
#include "zbuffer/tile/small_triangles-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace screen = view_detail::HWY_NAMESPACE;

/// A cluster's vertices on the screen. Only the cluster's own entries are set.
struct ScreenCluster {
  HWY_ALIGN_MAX std::int32_t x[Cluster::max_vertices], y[Cluster::max_vertices];
  HWY_ALIGN_MAX std::int32_t key[Cluster::max_vertices];  ///< bits of the float
};

class TilePainter {
 public:
  TilePainter(const FrameInput& frame, const TileJob& job, TileScratch& scratch)
      : frame_(frame),
        job_(job),
        buffer_(frame, job, scratch),
        large_(frame, job, buffer_),
        small_(frame, job, scratch, buffer_, large_) {}

  void Draw() {
    buffer_.Clear();
    DrawItems(job_.solid);
    if (!job_.cutouts.is_empty()) {
      TileHoles holes(frame_, job_);
      buffer_.MindHoles(holes);
      DrawItems(job_.cutouts);
    }
    buffer_.WriteOut();
  }

  // The sink functions of SortOut().

  [[nodiscard]] HWY_INLINE PixelRange ColumnsOf(const CoordinateRange& x) const { return small_.ColumnsOf(x); }
  [[nodiscard]] HWY_INLINE PixelRange RowsOf(const CoordinateRange& y) const { return small_.RowsOf(y); }
  [[nodiscard]] HWY_INLINE VU Ids() const { return hn::LoadU(DU(), frame_.set.id.data() + first_); }
  HWY_NOINLINE void PutLarge(MI large) {
    ForEachBit(BitsOf(DI(), large), [&](std::size_t lane) {
      const std::size_t at = first_ + lane;
      const std::uint8_t numbers[3] = {frame_.set.i0[at], frame_.set.i1[at], frame_.set.i2[at]};
      TriangleRecord record;
      record.id = frame_.set.id[at];
      for (int k = 0; k < 3; ++k) {
        record.x[k] = vertices_.x[numbers[k]];
        record.y[k] = vertices_.y[numbers[k]];
        record.key[k] = bits_as<float>(vertices_.key[numbers[k]]);
      }
      if (orient(record, frame_.facing)) large_.DrawOnce(record);
    });
  }
  HWY_INLINE void PutSmall(const PlacedPacket& placed) {
    const Compactor<DI> compact(placed.kept);
    TriangleQueue& queue = small_.queue();
    const std::size_t n = queue.count;
    for (int k = 0; k < 3; ++k) {
      compact.Store(placed.corners[k].x, queue.x[k] + n);
      compact.Store(placed.corners[k].y, queue.y[k] + n);
      compact.Store(LookUp64(vertices_.key, placed.corners[k].number), queue.key[k] + n);
    }
    compact.Store(Ids(), queue.id + n);
    queue.count += compact.count();
  }

 private:
  HWY_INLINE void Prefetch(std::uint32_t index) const {
    const Cluster& cluster = frame_.set.clusters[index];
    const ClusterSet& set = frame_.set;
    for (std::size_t i = 0; i < cluster.vertex_count; i += 16) {
      hwy::Prefetch(set.x.data() + cluster.first_vertex + i);
      hwy::Prefetch(set.y.data() + cluster.first_vertex + i);
      hwy::Prefetch(set.z.data() + cluster.first_vertex + i);
    }
    for (std::size_t i = 0; i < cluster.triangle_count; i += 64) {
      hwy::Prefetch(set.i0.data() + cluster.first_triangle + i);
      hwy::Prefetch(set.i1.data() + cluster.first_triangle + i);
      hwy::Prefetch(set.i2.data() + cluster.first_triangle + i);
    }
    for (std::size_t i = 0; i < cluster.triangle_count; i += 16)
      hwy::Prefetch(set.id.data() + cluster.first_triangle + i);
  }

  void DrawItems(const TileJob::Items& items) {
    large_.DrawAll(frame_.records, items.records);
    for (std::size_t i = 0; i < items.clusters.size(); ++i) {
      if (i + 2 < items.clusters.size()) Prefetch(items.clusters[i + 2]);
      const std::uint32_t cluster = items.clusters[i];
      const std::uint64_t blocks = buffer_.BlocksInTile(frame_.culled.rect(cluster));
      if (buffer_.AllHide(blocks, frame_.culled.nearest[cluster])) continue;
      DrawCluster(frame_.set.clusters[cluster]);
      // Triangles that wait in the queue lie within the cluster's blocks, so these marks hold for them, too.
      buffer_.MarkDrawn(blocks);
    }
    small_.Finish();
  }

  HWY_INLINE void TransformVertices(const Cluster& cluster) {
    const ScreenTransform& t = frame_.transform;
    const ClusterSet& set = frame_.set;
    const DF d;
    const DI di;
    const VI origin_x = hn::Set(di, t.centre_x - job_.x * kSubPixels);
    const VI origin_y = hn::Set(di, t.centre_y - job_.y * kSubPixels);
    for (std::size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(d)) {
      const std::size_t v = cluster.first_vertex + i;
      const auto snapped =
          screen::Snap(t, screen::Transform(t, hn::Load(d, set.x.data() + v), hn::Load(d, set.y.data() + v),
                                            hn::Load(d, set.z.data() + v)));
      hn::Store(hn::BitCast(di, snapped.key), di, vertices_.key + i);
      hn::Store(hn::Add(snapped.x, origin_x), di, vertices_.x + i);
      hn::Store(hn::Add(snapped.y, origin_y), di, vertices_.y + i);
    }
  }

  void DrawCluster(const Cluster& cluster) {
    TransformVertices(cluster);
    for (std::size_t i = 0; i < cluster.triangle_count; i += hn::Lanes(DI())) {
      Gather(cluster, i);
      small_.DrawFull();
    }
  }

  HWY_INLINE Corners Fetch(const Buffer<std::uint8_t>& numbers, std::size_t at) const {
    const DI d;
    const hn::Rebind<std::uint8_t, DI> d8;
    const VI number = hn::PromoteTo(d, hn::LoadU(d8, numbers.data() + at));
    return {number, LookUp64(vertices_.x, number), LookUp64(vertices_.y, number)};
  }

  /// Queues the triangles that may cover a sample of this tile; draws large ones at once.
  HWY_INLINE void Gather(const Cluster& cluster, std::size_t first) {
    first_ = cluster.first_triangle + first;
    const Corners corners[3] = {Fetch(frame_.set.i0, first_), Fetch(frame_.set.i1, first_),
                                Fetch(frame_.set.i2, first_)};
    SortOut(corners, AllLanes(), frame_.facing, *this);
  }

  const FrameInput& frame_;
  const TileJob& job_;
  TileBuffer buffer_;
  LargeTriangles large_;
  SmallTriangles small_;
  ScreenCluster vertices_;
  std::size_t first_ = 0;  // first triangle of the packet, in the columns of the set
};

void DrawTile(const FrameInput& frame, const TileJob& job, TileScratch& scratch) {
  if (job.is_empty()) {
    FillTile(frame, job);
  } else {
    TilePainter(frame, job, scratch).Draw();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawTile);

void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa) {
  kernel_for(DrawTileKernels, isa)(frame, job, scratch);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
