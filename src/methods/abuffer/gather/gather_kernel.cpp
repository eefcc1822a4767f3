// SPDX-License-Identifier: Apache-2.0
// The fragments of one tile: rasterised, counted and appended in one go, then placed into lists and sorted.
//
//    singles of the tile ------------------------> LargeFragments --+
//    clusters --fetch, bounds, facing--> small --> SmallFragments --+--> FragmentSink: masks, keys, numbers of arrival
//                                        large --> LargeFragments --+
//
// The sink is asked for room after every vector. If it has none, gather_tile() returns too_much, and the caller halves
// the tile. So the memory of a thread is bounded for every scene.

#include "abuffer/gather/gather_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/gather/gather_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "abuffer/gather/fragment_sink-inl.h"
#include "abuffer/gather/triangles-inl.h"
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
      // Room is checked for each triangle, because a vector of large triangles may add more fragments than kMostAtOnce.
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

// The functions below turn fragments in the order of arrival into sorted lists. The lists of the sixteen pixels of a
// group all have the length of the longest.

// Keys are not negative, so words may be compared as signed: AVX2 has no other comparison.
using DW = hn::ScalableTag<std::int64_t>;

HWY_INLINE void CompareExchange(std::int64_t* a, std::int64_t* b) {
  const DW d;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
    const auto va = hn::Load(d, a + i), vb = hn::Load(d, b + i);
    // Empty slots are 0 and so sink to the end of their lists, whatever their lengths.
    hn::Store(hn::Max(va, vb), d, a + i);
    hn::Store(hn::Min(va, vb), d, b + i);
  }
}

/// Sorts the sixteen lists of a group, greatest first, by one sorting network: K. Batcher. Sorting Networks and Their
/// Applications. 1968; as algorithm M of D. Knuth, The Art of Computer Programming 3, 5.2.2, which takes any length.
/// Measured against separate lists one after the other: insertion sort takes 7 to 8 times as long, std::sort 9 times.
HWY_INLINE void SortGroup(std::uint64_t* slots, std::size_t length) {
  auto* words = reinterpret_cast<std::int64_t*>(slots);
  if (length < 2) return;
  std::size_t top = 1;
  while (2 * top < length) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      // The loops visit all i with (i & p) == r, which are every other block of p numbers.
      for (std::size_t begin = r; begin + d < length; begin += 2 * p)
        for (std::size_t i = begin; i < HWY_MIN(begin + p, length - d); ++i)
          CompareExchange(words + i * kGroup, words + (i + d) * kGroup);
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

/// Sorts fragments of equal keys, which are in the order of arrival, by id.
inline void OrderTies(GatherScratch& s, std::size_t group, std::size_t lane) {
  const auto length = s.length(group);
  const auto at = [&](std::size_t i) -> std::uint64_t& { return s.slot(group, i)[lane]; };
  const auto id = [&](std::uint64_t word) { return s.triangles.id[s.arrived.triangle[~std::uint32_t(word)]]; };
  for (std::size_t begin = 0; begin < length && at(begin) != 0;) {
    std::size_t end = begin + 1;
    // An empty slot has the key 0 as well.
    while (end < length && at(end) != 0 && at(end) >> 32 == at(begin) >> 32) ++end;
    if (end - begin > 1) {
      std::vector<std::uint64_t>& run = s.run;
      run.clear();
      for (std::size_t i = begin; i < end; ++i) run.push_back(at(i));
      // Pieces of one clipped triangle have one id; their masks are disjoint, and so give a definite order.
      std::sort(run.begin(), run.end(), [&](std::uint64_t a, std::uint64_t b) {
        const PrimitiveId ia = id(a), ib = id(b);
        if (ia != ib) return ia < ib;
        return s.arrived.mask(~std::uint32_t(a)) < s.arrived.mask(~std::uint32_t(b));
      });
      for (std::size_t i = begin; i < end; ++i) at(i) = run[i - begin];
    }
    begin = end;
  }
}

inline void FindTies(GatherScratch& s, std::size_t group) {
  const DW d;
  const std::size_t length = s.length(group);
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
    auto tied = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (std::size_t i = 0; i + 1 < length; ++i) {
      const auto a = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i)) + lane);
      const auto b = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i + 1)) + lane);
      // Empty slots are 0 and tie with each other, but in a real tie b is not 0.
      const auto equal = hn::Eq(hn::ShiftRight<32>(a), hn::ShiftRight<32>(b));
      tied = hn::Or(tied, hn::And(equal, hn::Ne(b, hn::Zero(d))));
    }
    for (std::uint64_t left = BitsOf(d, tied); left != 0; left &= left - 1)
      OrderTies(s, group, lane + hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
  }
}

/// Makes room for the lists. The number of fragments of each pixel becomes the offset of its list, in words.
HWY_INLINE void MakeRoom(GatherScratch& s) {
  const DU d;
  std::uint32_t base = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    s.group_base[g] = base;
    VU longest = hn::Zero(d);
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
      std::uint32_t* counts = s.counts.data() + g * kGroup + i;
      longest = hn::Max(longest, hn::Load(d, counts));
      hn::Store(CountFrom(d, std::uint32_t(base * kGroup + i)), d, counts);
    }
    base += hn::GetLane(hn::MaxOfLanes(d, longest));
  }
  s.group_base[kGroups] = base;
  const std::size_t words = std::size_t(base) * kGroup;
  if (s.slots.size() < words) s.slots = Buffer<std::uint64_t>(words + words / 4);
  std::fill_n(s.slots.data(), words, std::uint64_t(0));
}

HWY_INLINE void Place(GatherScratch& s) {
  const std::uint32_t *place = s.arrived.place.data(), *key = s.arrived.key.data(), *begin = s.counts.data();
  auto* slots = reinterpret_cast<char*>(s.slots.data());
  const std::size_t count = s.arrived.count;
  for (std::size_t n = Arrived::first; n < count; ++n) {
    const std::size_t rank = place[n] & kMostOfPixel;
    const std::uint64_t word = std::uint64_t(key[n]) << 32 | ~std::uint32_t(n);
    // The pointer is to bytes, which may alias any other array: otherwise g++ makes a scatter, which takes longer.
    std::memcpy(slots + (begin[place[n] >> kRankBits] + rank * kGroup) * sizeof word, &word, sizeof word);
  }
}

inline void SortLists(GatherScratch& s) {
  MakeRoom(s);
  Place(s);
  for (std::size_t g = 0; g < kGroups; ++g) {
    SortGroup(s.slot(g, 0), s.length(g));
    FindTies(s, g);
  }
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
