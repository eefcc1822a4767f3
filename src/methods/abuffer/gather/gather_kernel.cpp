// SPDX-License-Identifier: Apache-2.0
// The fragments of one tile: rasterised, counted and appended in one go, then placed into lists and sorted.
//
//    singles of the tile ------------------------> LargeFragments --+
//    clusters --fetch, bounds, facing--> small --> SmallFragments --+--> FragmentSink: masks, keys, numbers of arrival
//                                        large --> LargeFragments --+
//
// The sink is asked for room after every vector. If it has none, the tile is returned as too much, and the caller
// halves it. So the memory of a thread is bounded for every scene.

#include "abuffer/gather/gather_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/gather/gather_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "abuffer/gather/fragment_sink-inl.h"
#include "abuffer/gather/large_triangles-inl.h"
#include "abuffer/gather/list_sort-inl.h"
#include "abuffer/gather/small_triangles-inl.h"
#include "view/facing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class TileGatherer {
 public:
  TileGatherer(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch)
      : frame_(frame), job_(job), sink_(frame, job, scratch), large_(sink_), small_(sink_, scratch, large_) {}

  /// \returns false if there are too many fragments.
  bool Run() {
    if (!DrawSingles()) return false;
    for (const std::uint32_t cluster : frame_.plan.clusters(job_.tile))
      if (!DrawCluster(frame_.plan.set().clusters[cluster])) return false;
    small_.Finish();
    return sink_.HasRoom();
  }

 private:
  bool DrawSingles() {
    const auto singles = frame_.plan.singles();
    const auto listed = frame_.plan.singles(job_.tile);
    const std::size_t count = listed ? listed->size() : singles.size();
    for (std::size_t i = 0; i < count; ++i) {
      ScreenTriangle t = singles[listed ? (*listed)[i] : i];
      for (int k = 0; k < 3; ++k) {
        t.x[k] -= job_.pixels.x * kSubPixels;
        t.y[k] -= job_.pixels.y * kSubPixels;
      }
      large_.Draw(t);
      if (!sink_.HasRoom()) return false;
    }
    return true;
  }

  bool DrawCluster(const Cluster& cluster) {
    for (std::size_t i = 0; i < cluster.triangle_count; i += hn::Lanes(DI())) {
      Queue(cluster, cluster.first_triangle + i);
      while (small_.IsFull()) {
        small_.DrawQueued();
        if (!sink_.HasRoom()) return false;
      }
    }
    return true;
  }

  struct Corners {
    VI number, x, y;
  };
  HWY_INLINE Corners Fetch(const Cluster& cluster, const Buffer<std::uint8_t>& numbers, std::size_t at) const {
    const DI d;
    const hn::Rebind<std::uint8_t, DI> d8;
    const ScreenClusters& screen = frame_.plan.screen();
    const ScreenTransform& t = frame_.plan.transform();
    const VI number = hn::PromoteTo(d, hn::LoadU(d8, numbers.data() + at));
    const VI x = hn::GatherIndex(d, screen.x.data() + cluster.first_vertex, number);
    const VI y = hn::GatherIndex(d, screen.y.data() + cluster.first_vertex, number);
    return {number, hn::Add(x, hn::Set(d, t.centre_x - job_.pixels.x * kSubPixels)),
            hn::Add(y, hn::Set(d, t.centre_y - job_.pixels.y * kSubPixels))};
  }

  /// Queues the triangles that may cover a sample of this tile; draws large ones at once.
  HWY_INLINE void Queue(const Cluster& cluster, std::size_t at) {
    const DI d;
    const ClusterSet& set = frame_.plan.set();
    const Corners a = Fetch(cluster, set.i0, at), b = Fetch(cluster, set.i1, at), c = Fetch(cluster, set.i2, at);
    const VI x_min = hn::Min(a.x, hn::Min(b.x, c.x)), x_max = hn::Max(a.x, hn::Max(b.x, c.x));
    const VI y_min = hn::Min(a.y, hn::Min(b.y, c.y)), y_max = hn::Max(a.y, hn::Max(b.y, c.y));
    const FragmentBounds p = sink_.BoundsOf(x_min, x_max, y_min, y_max);
    MI keep = hn::And(hn::Not(hn::Gt(p.x0, p.x1)), hn::Not(hn::Gt(p.y0, p.y1)));
    if (hn::AllFalse(d, keep)) return;

    // Only small triangles have products that fit 32 bits, in the area below and in the edge functions of their batch.
    const VI extent = hn::Max(hn::Sub(x_max, x_min), hn::Sub(y_max, y_min));
    const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
    if (!hn::AllFalse(d, large)) {
      DrawLargeLanes(cluster, at, large);
      keep = hn::AndNot(large, keep);
    }
    const VI area =
        hn::Sub(hn::Mul(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y)), hn::Mul(hn::Sub(c.x, a.x), hn::Sub(b.y, a.y)));
    const MI front = hn::Lt(area, hn::Zero(d));  // counter-clockwise to the eye; y is down
    const MI back = hn::And(keep, hn::Gt(area, hn::Zero(d)));
    const auto ids = [&]() HWY_ATTR { return hn::LoadU(DU(), set.id.data() + at); };
    keep = hn::And(keep, view_detail::HWY_NAMESPACE::Kept(d, frame_.plan.facing(), front, back, ids));
    if (hn::AllFalse(d, keep)) return;

    // Swapping the last two vertices of front faces makes the area positive.
    const float* key = frame_.plan.screen().key.data() + cluster.first_vertex;
    const auto key_of = [&](VI number) HWY_ATTR { return hn::BitCast(d, hn::GatherIndex(DF(), key, number)); };
    const VI bn = hn::IfThenElse(front, c.number, b.number), cn = hn::IfThenElse(front, b.number, c.number);
    const VI fields[FragmentQueue::kFields] = {a.x,
                                               hn::IfThenElse(front, c.x, b.x),
                                               hn::IfThenElse(front, b.x, c.x),
                                               a.y,
                                               hn::IfThenElse(front, c.y, b.y),
                                               hn::IfThenElse(front, b.y, c.y),
                                               key_of(a.number),
                                               key_of(bn),
                                               key_of(cn),
                                               hn::BitCast(d, ids())};
    small_.Append(fields, keep);
  }

  void DrawLargeLanes(const Cluster& cluster, std::size_t at, MI large) {
    const ClusterSet& set = frame_.plan.set();
    const ScreenClusters& screen = frame_.plan.screen();
    const ScreenTransform& t = frame_.plan.transform();
    for (std::uint64_t left = BitsOf(DI(), large); left != 0; left &= left - 1) {
      const std::size_t i = at + hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
      const std::uint8_t numbers[3] = {set.i0[i], set.i1[i], set.i2[i]};
      ScreenTriangle triangle;
      triangle.id = set.id[i];
      for (int k = 0; k < 3; ++k) {
        const std::size_t v = cluster.first_vertex + numbers[k];
        triangle.x[k] = screen.x[v] + t.centre_x - job_.pixels.x * kSubPixels;
        triangle.y[k] = screen.y[v] + t.centre_y - job_.pixels.y * kSubPixels;
        triangle.key[k] = screen.key[v];
      }
      if (!orient(triangle, frame_.plan.facing())) continue;
      // A vector of large triangles may add more fragments than there is room for at once.
      if (!sink_.HasRoom()) return;
      large_.Draw(triangle);
    }
  }

  const GatherInput& frame_;
  const GatherJob& job_;
  FragmentSink sink_;
  LargeFragments large_;
  SmallFragments small_;
};

Gathered GatherTile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch) {
  std::fill(scratch.counts.begin(), scratch.counts.end(), 0u);
  scratch.arrived.count = Arrived::first;
  scratch.triangles.clear();
  if (!TileGatherer(frame, job, scratch).Run()) return Gathered::too_much;
  return scratch.arrived.count == Arrived::first ? Gathered::nothing : Gathered::something;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::abuffer_detail {

FRONTMOST_KERNELS(GatherTile);
FRONTMOST_KERNELS(SortLists);

Gathered gather_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch) {
  return kernel_for(GatherTileKernels, frame.isa)(frame, job, scratch);
}

void sort_lists(Isa isa, GatherScratch& scratch) { kernel_for(SortListsKernels, isa)(scratch); }

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
