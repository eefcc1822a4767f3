// SPDX-License-Identifier: Apache-2.0
// Drawing one tile: triangles into a private buffer of 64-bit words, many triangles at a time while they are small.
//
// J. Pineda. A Parallel Algorithm for Polygon Rasterization. 1988 (edge functions).
//
// Coordinates are relative to the tile, in 1/256 pixel. Coverage: E >= 0 for three edge functions, biased by the
// top-left rule (y down, area positive: an edge is left where it goes up, top where it is level and goes right). Pixels
// are 256 units apart, so an edge value may be shifted right by 8 before stepping: a step is then -dy or dx, and the
// sign is still exact.
//
// The key at a sample is that of view/triangle_keys.h. Every path evaluates exactly this, so they agree to the bit.

#include "zbuffer/tile/tile_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/tile/tile_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "view/snap-inl.h"
#include "zbuffer/tile/large_triangles-inl.h"
#include "zbuffer/tile/small_triangles-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace screen = view_detail::HWY_NAMESPACE;

/// A cluster's vertices on the screen. Only those that it has are set.
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
    large_.DrawAll(frame_.records, job_.records);
    for (std::size_t i = 0; i < job_.clusters.size(); ++i) {
      if (i + 2 < job_.clusters.size()) Prefetch(job_.clusters[i + 2]);
      const std::uint32_t cluster = job_.clusters[i];
      const std::uint64_t blocks = buffer_.BlocksInTile(frame_.culled.rect(cluster));
      if (buffer_.AllHide(blocks, frame_.culled.nearest[cluster])) continue;
      DrawCluster(frame_.set.clusters[cluster]);
      // Triangles in the queue stay within the cluster's blocks, whenever they are drawn.
      buffer_.MarkDrawn(blocks);
    }
    small_.Finish();
    buffer_.WriteOut();
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

  /// Puts the triangles that may cover a sample of this tile into the queue; large ones are drawn at once.
  HWY_INLINE void Gather(const Cluster& cluster, std::size_t first) {
    const DI d;
    const std::size_t at = cluster.first_triangle + first;
    const Corners a = Fetch(frame_.set.i0, at), b = Fetch(frame_.set.i1, at), c = Fetch(frame_.set.i2, at);

    const CoordinateRange x = RangeOf(a.x, b.x, c.x), y = RangeOf(a.y, b.y, c.y);
    const PixelRange columns = small_.ColumnsOf(x), rows = small_.RowsOf(y);
    MI keep = hn::And(hn::Not(hn::Gt(columns.first, columns.last)), hn::Not(hn::Gt(rows.first, rows.last)));
    if (hn::AllFalse(d, keep)) return;

    const VI extent = hn::Max(hn::Sub(x.greatest, x.least), hn::Sub(y.greatest, y.least));
    const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
    if (!hn::AllFalse(d, large)) {
      DrawLargeLanes(cluster, first, large);
      keep = hn::AndNot(large, keep);
    }

    const Winding winding = WindingOf(frame_.view.culling, a, b, c);
    keep = hn::And(keep, winding.kept);
    if (hn::AllFalse(d, keep)) return;

    const Compactor<DI> compact(keep);
    TriangleQueue& queue = small_.queue();
    const std::size_t n = queue.count;
    const auto store = [&](int k, const Corners& corner) HWY_ATTR {
      compact.Store(corner.x, queue.x[k] + n);
      compact.Store(corner.y, queue.y[k] + n);
      compact.Store(LookUp64(vertices_.key, corner.number), queue.key[k] + n);
    };
    store(0, a);
    store(1, Chosen(winding.front, c, b));
    store(2, Chosen(winding.front, b, c));
    compact.Store(hn::LoadU(DU(), frame_.set.id.data() + at), queue.id + n);
    queue.count += compact.count();
  }

  void DrawLargeLanes(const Cluster& cluster, std::size_t first, MI large) {
    ForEachBit(BitsOf(DI(), large), [&](std::size_t lane) {
      const std::size_t at = cluster.first_triangle + first + lane;
      const std::uint8_t numbers[3] = {frame_.set.i0[at], frame_.set.i1[at], frame_.set.i2[at]};
      TriangleRecord record;
      record.id = frame_.set.id[at];
      for (int k = 0; k < 3; ++k) {
        record.x[k] = vertices_.x[numbers[k]];
        record.y[k] = vertices_.y[numbers[k]];
        std::memcpy(&record.key[k], &vertices_.key[numbers[k]], sizeof(float));
      }
      if (orient(record, frame_.view.culling)) large_.DrawOnce(record);
    });
  }

  const FrameInput& frame_;
  const TileJob& job_;
  TileBuffer buffer_;
  LargeTriangles large_;
  SmallTriangles small_;
  ScreenCluster vertices_;
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
