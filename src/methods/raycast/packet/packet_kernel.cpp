// SPDX-License-Identifier: Apache-2.0
// Casts a packet of a scan's rays through the tree: nearest boxes first, sixteen boxes or triangles at a time, for all
// rays together.
//
// I. Wald, P. Slusallek, C. Benthin, M. Wagner. Interactive Rendering with Coherent Ray Tracing. 2001.
//
//     ray ----[===]------[=====]-->    The place where a ray meets a triangle is known to within an interval. `end` is
//            from to                   the end of the nearest certain interval, `other` the beginning of the first of
//                                      all others. If `other` is beyond `end`, the triangle is the nearest, and its
//                                      place is computed by the arithmetic of meet(). The few remaining rays, at
//                                      edges, holes and doubled surfaces, ask meet() for each triangle.

#include <algorithm>
#include <array>
#include <cmath>

#include "raycast/packet/scan_packet.h"
#include "raycast/query/queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/packet/packet_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lanes-inl.h"
#include "base/wasm_lanes-inl.h"
#include "raycast/packet/packet_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class PacketHits {
 public:
  PacketHits(const RayTree& tree, const PacketCone& cone, ScanScratch& scratch)
      : tree_(tree), cone_(cone), notes_(scratch.notes) {
    constexpr float all = kFloatInfinity;
    for (std::size_t i = 0; i < kScanRays; ++i) {
      end_[i] = cone.valid() >> i & 1 ? all : -all;
      from_[i] = other_[i] = all;
      note_[i] = -1;
    }
    for (std::size_t block = 0; block < kScanBlocks; ++block)
      block_end_[block] = cone.valid() >> (block * kBlockRays) & 0xFFFF ? all : -all;
    packet_end_ = all;
  }

  /// Distances beyond which no ray of a block, or of the packet, meets its nearest triangle. So a triangle that begins
  /// beyond such a distance need not be tested.
  [[nodiscard]] HWY_INLINE const float* block_ends() const { return block_end_; }
  [[nodiscard]] HWY_INLINE float packet_end() const { return packet_end_; }

  void MeetLeaf(const RayLeaf& leaf) {
    PacketTriangles triangles;
    TrianglePlacer placer(cone_, leaf, triangles);
    bool is_nearer = false;
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes)
      for (std::uint32_t left = placer.Place(first, block_end_); left != 0; left &= left - 1)
        is_nearer |= MeetTriangle(leaf, triangles, first, hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
    if (is_nearer) UpdateEnds();
  }

  void WriteOut(ScanPacket& packet, Isa isa) {
    const std::uint64_t single = SingleRays();
    WritePlaces(packet, single);
    for (std::uint64_t left = cone_.valid() & ~single & SeenRays(); left != 0; left &= left - 1)
      Settle(packet, std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(left)), isa);
  }

 private:
  static constexpr std::uint64_t kAllLanes = (std::uint64_t(1) << kQueryLanes) - 1;
  /// A margin for comparing ends with values that were rounded differently.
  static constexpr float kBeyond = 1 + 0x1p-20f;

  /// One triangle, in the form that all rays share.
  struct Edges {
    QV normal[3][3], z[3], low_z, high_z, bound, error;
  };
  [[nodiscard]] static HWY_INLINE Edges EdgesOf(const PacketTriangles& t, std::size_t lane) {
    const QF d;
    Edges e;
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) e.normal[k][axis] = hn::Set(d, t.normal[k][axis][lane]);
      e.z[k] = hn::Set(d, t.z[k][lane]);
    }
    e.low_z = hn::Set(d, t.low_z[lane]), e.high_z = hn::Set(d, t.high_z[lane]);
    e.bound = hn::Set(d, t.bound[lane]), e.error = hn::Set(d, t.error[lane]);
    return e;
  }

  /// Tests the rays against one triangle. \returns true if the triangle is the nearest so far of some ray.
  HWY_INLINE bool MeetTriangle(const RayLeaf& leaf, const PacketTriangles& t, std::size_t first, std::size_t index) {
    const std::size_t lane = first + index;
    const Edges edges = EdgesOf(t, lane);
    const bool is_whole = !tree_.cutouts || !tree_.cutouts->has(leaf.id[lane]);
    if (note_count_ == notes_.size()) Forget();
    std::uint64_t rays = 0;
    bool is_nearer = false;
    for (std::size_t block = 0; block < kScanBlocks; ++block) {
      if ((t.blocks[block] >> index & 1) == 0) continue;
      for (std::size_t i = 0; i < kBlockRays; i += kQueryLanes) {
        const std::size_t first_ray = block * kBlockRays + i;
        rays |= MeetRays(edges, first_ray, is_whole, is_nearer) << first_ray;
      }
    }
    if (rays != 0) notes_[note_count_++] = {leaf.corners_of(lane), leaf.id[lane], rays};
    return is_nearer;
  }

  /// \returns the rays that may meet the triangle first.
  HWY_INLINE std::uint64_t MeetRays(const Edges& t, std::size_t first, bool is_whole, bool& is_nearer) {
    const QF d;
    const QV su = cone_.SlopesU(first), sv = cone_.SlopesV(first);
    QV e[3];
    for (int k = 0; k < 3; ++k)
      e[k] = hn::Add(hn::Add(t.normal[k][2], hn::Mul(su, t.normal[k][0])), hn::Mul(sv, t.normal[k][1]));
    const QV least = hn::Min(hn::Min(e[0], e[1]), e[2]), most = hn::Max(hn::Max(e[0], e[1]), e[2]);
    const QV below = hn::Neg(t.bound);
    const QM missed = hn::And(hn::Gt(most, t.bound), hn::Lt(least, below));
    if (frontmost::HWY_NAMESPACE::BitsOf(d, missed) == kAllLanes) return 0;

    const QM inside = hn::Or(hn::Gt(least, t.bound), hn::Lt(most, below));
    const QV share = hn::Div(hn::Set(d, 1.0f), hn::Add(hn::Add(e[0], e[1]), e[2]));
    const QV sum = hn::Add(hn::Add(hn::Mul(e[0], t.z[0]), hn::Mul(e[1], t.z[1])), hn::Mul(e[2], t.z[2]));
    // Each of the weights may be wrong by `bound`.
    const QV wrong = hn::Mul(hn::Mul(t.bound, hn::Abs(share)), hn::Set(d, 12.0f));
    const QV slack = hn::Mul(hn::Sub(t.high_z, t.low_z), wrong);
    const QV place = hn::Mul(sum, share);
    const QV nearest = hn::IfThenElse(inside, hn::Max(hn::Sub(place, slack), t.low_z), t.low_z);
    const QV farthest = hn::IfThenElse(inside, hn::Min(hn::Add(place, slack), t.high_z), t.high_z);
    const QV from = hn::Sub(nearest, t.error), to = hn::Add(farthest, t.error);
    const QV end = hn::Load(d, end_ + first);
    const QM beyond = hn::Or(hn::Lt(to, hn::Zero(d)), hn::Gt(from, hn::Mul(end, hn::Set(d, kBeyond))));
    const QM met = hn::Not(hn::Or(missed, beyond));
    const std::uint64_t bits = frontmost::HWY_NAMESPACE::BitsOf(d, met);
    if (bits == 0) return 0;
    const QM certain = hn::And(hn::And(met, inside), hn::Gt(from, hn::Zero(d)));
    is_nearer |= Keep(first, met, is_whole ? certain : hn::MaskFromVec(hn::Zero(d)), from, to);
    return bits;
  }

  HWY_INLINE bool Keep(std::size_t first, QM met, QM certain, QV from, QV to) {
    const QF d;
    const QI di;
    const QV end = hn::Load(d, end_ + first), old_from = hn::Load(d, from_ + first);
    const QM nearer = hn::And(certain, hn::Lt(to, end));
    // A triangle that is not the nearest counts among the others.
    const QV loser = hn::IfThenElse(nearer, old_from, hn::IfThenElse(met, from, hn::Set(d, kFloatInfinity)));
    hn::Store(hn::Min(hn::Load(d, other_ + first), loser), d, other_ + first);
    hn::Store(hn::IfThenElse(nearer, to, end), d, end_ + first);
    hn::Store(hn::IfThenElse(nearer, from, old_from), d, from_ + first);
    const auto number = hn::Set(di, std::int32_t(note_count_));
    hn::Store(hn::IfThenElse(hn::RebindMask(di, nearer), number, hn::Load(di, note_ + first)), di, note_ + first);
    return !hn::AllFalse(d, nearer);
  }

  HWY_INLINE void UpdateEnds() {
    const QF d;
    packet_end_ = -kFloatInfinity;
    for (std::size_t block = 0; block < kScanBlocks; ++block) {
      const float* const from = end_ + block * kBlockRays;
      QV ends = hn::Load(d, from);
      for (std::size_t i = kQueryLanes; i < kBlockRays; i += kQueryLanes) ends = hn::Max(ends, hn::Load(d, from + i));
      block_end_[block] = hn::GetLane(hn::MaxOfLanes(d, ends)) * kBeyond;
      packet_end_ = std::max(packet_end_, block_end_[block]);
    }
  }

  /// Keeps only the notes of triangles that are the nearest of some ray. Rays whose nearest triangle is uncertain must
  /// then be cast again.
  void Forget() {
    is_complete_ = false;
    std::array<std::int32_t, ScanScratch::kMostNotes> moved;
    moved.fill(-1);
    for (const std::int32_t note : note_)
      if (note >= 0) moved[std::size_t(note)] = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < note_count_; ++i) {
      if (moved[i] < 0) continue;
      notes_[count] = notes_[i];
      moved[i] = std::int32_t(count++);
    }
    for (std::int32_t& note : note_)
      if (note >= 0) note = moved[std::size_t(note)];
    note_count_ = count;
  }

  /// Returns the rays whose nearest triangle is certain.
  [[nodiscard]] std::uint64_t SingleRays() const {
    const QF d;
    std::uint64_t single = 0;
    for (std::size_t first = 0; first < kScanRays; first += kQueryLanes) {
      const QV end = hn::Mul(hn::Load(d, end_ + first), hn::Set(d, kBeyond));
      const QM alone = hn::Gt(hn::Load(d, other_ + first), end);
      const QM met = hn::RebindMask(d, hn::Gt(hn::Load(QI(), note_ + first), hn::Set(QI(), -1)));
      single |= frontmost::HWY_NAMESPACE::BitsOf(d, hn::And(alone, met)) << first;
    }
    return single;
  }

  /// Returns the rays that may meet anything.
  [[nodiscard]] std::uint64_t SeenRays() const {
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kScanRays; ++i) seen |= std::uint64_t(note_[i] >= 0 || other_[i] < kFloatInfinity) << i;
    return seen;
  }

  // -- the end ----------------------------------------------------------------------------------------------------

  using PD = hn::CappedTag<double, kRayLanes>;
  using PV = hn::Vec<PD>;
  using PF = hn::Rebind<float, PD>;
  static constexpr std::size_t kDoubleLanes = hn::MaxLanes(PD());

  /// The vertices of each ray's nearest triangle. Rays whose nearest triangle is uncertain have the vertices of any
  /// triangle.
  struct Winners {
    alignas(64) float corner[3][3][kScanRays];
  };

  void WritePlaces(ScanPacket& packet, std::uint64_t single) const {
    std::fill_n(packet.primitive, kScanRays, no_primitive);
    std::fill_n(packet.range, kScanRays, kFloatInfinity);
    if (single == 0) return;
    Winners winners;
    const std::size_t some = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(single));
    for (std::size_t i = 0; i < kScanRays; ++i) {
      const NotedTriangle& note = notes_[std::size_t(note_[single >> i & 1 ? i : some])];
      if (single >> i & 1) packet.primitive[i] = note.id;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) winners.corner[k][axis][i] = note.corners[k][int(axis)];
    }
    for (std::size_t first = 0; first < kScanRays; first += kDoubleLanes) {
      const std::uint64_t lanes = single >> first & ((std::uint64_t(1) << kDoubleLanes) - 1);
      if (lanes == 0) continue;
      alignas(64) float range[kDoubleLanes];
      hn::Store(RangeOf(packet, winners, first), PF(), range);
      for (std::uint64_t left = lanes; left != 0; left &= left - 1) {
        const std::size_t lane = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
        packet.range[first + lane] = range[lane];
      }
    }
  }

  /// Returns place_along() times the direction's length, with the same operations in the same order.
  [[nodiscard]] HWY_INLINE hn::Vec<PF> RangeOf(const ScanPacket& packet, const Winners& winners,
                                               std::size_t first) const {
    const PD d;
    const PF df;
    PV c[3][3], along[3];
    PV nearest = hn::Set(d, std::numeric_limits<double>::denorm_min());
    PV farthest = hn::Set(d, std::numeric_limits<double>::max());
    for (int axis = 0; axis < 3; ++axis) {
      along[axis] = hn::PromoteTo(d, hn::Load(df, packet.direction[axis] + first));
      for (int k = 0; k < 3; ++k)
        c[k][axis] = hn::Sub(hn::PromoteTo(d, hn::Load(df, winners.corner[k][axis] + first)),
                             hn::Set(d, double(packet.origin[axis])));
      const PV low = hn::Div(hn::Min(hn::Min(c[0][axis], c[1][axis]), c[2][axis]), along[axis]);
      const PV high = hn::Div(hn::Max(hn::Max(c[0][axis], c[1][axis]), c[2][axis]), along[axis]);
      const auto moves = hn::Ne(along[axis], hn::Zero(d));
      nearest = hn::IfThenElse(moves, hn::Max(nearest, hn::Min(low, high)), nearest);
      farthest = hn::IfThenElse(moves, hn::Min(farthest, hn::Max(low, high)), farthest);
    }
    PV ab[3], ac[3];
    for (int axis = 0; axis < 3; ++axis) {
      ab[axis] = hn::Sub(c[1][axis], c[0][axis]);
      ac[axis] = hn::Sub(c[2][axis], c[0][axis]);
    }
    const auto crossed = [&](int i, int k) HWY_ATTR { return hn::Sub(hn::Mul(ab[i], ac[k]), hn::Mul(ac[i], ab[k])); };
    const PV n[3] = {crossed(1, 2), crossed(2, 0), crossed(0, 1)};
    const PV t = hn::Div(Dot(n, c[0]), Dot(n, along));
    const PV within = hn::IfThenElse(hn::Eq(t, t), hn::Max(t, nearest), nearest);
    const PV place = hn::Max(hn::Min(within, farthest), hn::Set(d, std::numeric_limits<double>::denorm_min()));
    return hn::DemoteTo(df, hn::Mul(place, hn::Sqrt(Dot(along, along))));
  }

  static HWY_INLINE PV Dot(const PV (&a)[3], const PV (&b)[3]) {
    return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
  }

  /// Answers one ray by meet(), the definition of a hit.
  void Settle(ScanPacket& packet, std::size_t ray, Isa isa) const {
    const Query query = packet.query_of(ray);
    RayHit nearest;
    if (!is_complete_) {
      walk_batch(tree_, {&query, 1}, Want::closest, {&nearest, 1}, isa);
    } else {
      for (std::size_t i = 0; i < note_count_; ++i) {
        if ((notes_[i].rays >> ray & 1) == 0) continue;
        const RayHit hit = meet(query, notes_[i].corners, notes_[i].id);
        const bool is_nearer = hit && (hit.t < nearest.t || (hit.t == nearest.t && hit.primitive < nearest.primitive));
        if (is_nearer && !passes(tree_, query, hit)) nearest = hit;
      }
    }
    packet.primitive[ray] = nearest.primitive;
    packet.range[ray] = range_of(nearest, query.direction);
  }

  const RayTree& tree_;
  const PacketCone& cone_;
  std::array<NotedTriangle, ScanScratch::kMostNotes>& notes_;
  std::size_t note_count_ = 0;
  bool is_complete_ = true;  ///< the notes hold every triangle that a ray may meet first
  alignas(64) float end_[kScanRays], from_[kScanRays], other_[kScanRays];
  alignas(64) std::int32_t note_[kScanRays];
  float block_end_[kScanBlocks], packet_end_;
};

class PacketWalker {
 public:
  PacketWalker(const RayTree& tree, const PacketCone& cone, ScanScratch& scratch)
      : cone_(cone), tree_(tree), stack_(scratch.stack.data()), hits_(tree, cone, scratch) {
    stack_[waiting_++] = {0, tree.root};
  }

  PacketHits& Walk() {
    while (waiting_ > 0) {
      const ScanScratch::Waiting next = stack_[--waiting_];
      if (next.place > hits_.packet_end()) continue;
      if (next.child & kLeafBit) {
        hits_.MeetLeaf(tree_.leaf(next.child));
      } else {
        LookInto(tree_.nodes[next.child]);
      }
      if (waiting_ > 0) tree_.prefetch(stack_[waiting_ - 1].child);
    }
    return hits_;
  }

 private:
  /// Pushes the children that rays may meet, the nearest last.
  void LookInto(const RayNode& node) {
    const QF d;
    alignas(64) std::int32_t bits[kRayLanes + kQueryLanes];
    alignas(64) std::uint32_t child[kRayLanes + kQueryLanes];
    std::size_t count = 0;
    for (std::size_t first = 0; first < node.count; first += kQueryLanes) {
      const PacketCone::Missed missed = cone_.Misses(node, first, hits_.block_ends());
      const Compactor<QF> entered(hn::AndNot(missed.boxes, hn::FirstN(d, node.count - first)));
      entered.Store(hn::BitCast(QI(), missed.place), bits + count);
      entered.Store(hn::Load(QU(), node.child + first), child + count);
      count += entered.count();
    }
    for (std::size_t i = 0; i < count; ++i)
      stack_[waiting_ + RankOf(bits, count, i)] = {bits_as<float>(bits[i]), child[i]};
    waiting_ += count;
  }

  const PacketCone& cone_;
  const RayTree& tree_;
  ScanScratch::Waiting* stack_;
  std::size_t waiting_ = 0;
  PacketHits hits_;
};

/// Casts the rays of a packet together. \returns false if the rays must be cast one by one.
bool CastTogether(const RayTree& tree, ScanPacket& packet, ScanScratch& scratch, Isa isa) {
  PacketCone cone;
  if (!cone.Take(packet)) return false;
  PacketWalker(tree, cone, scratch).Walk().WriteOut(packet, isa);
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(CastTogether);

void cast_scan(const RayTree& tree, ScanPacket& packet, ScanScratch& scratch, Isa isa) {
  if (tree.root != no_index && kernel_for(CastTogetherKernels, isa)(tree, packet, scratch, isa)) return;
  std::array<Query, kScanRays> queries;
  std::array<RayHit, kScanRays> hits;
  for (std::size_t i = 0; i < packet.count; ++i) queries[i] = packet.query_of(i);
  walk_batch(tree, {queries.data(), packet.count}, Want::closest, {hits.data(), packet.count}, isa);
  for (std::size_t i = 0; i < packet.count; ++i) {
    packet.primitive[i] = hits[i].primitive;
    packet.range[i] = range_of(hits[i], queries[i].direction);
  }
}

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
