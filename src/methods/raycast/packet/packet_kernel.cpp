// SPDX-License-Identifier: Apache-2.0
// Casts a packet of a scan's rays through the tree: nearest boxes first, sixteen boxes or triangles at a time, for all
// rays together.
//
//    rays --> cone --> boxes that it may meet --> triangles --> nearest of each ray
//              |                                                      |
//              +-- too wide: single rays                              +-- ids, ranges
//
// I. Wald, P. Slusallek, C. Benthin, M. Wagner. Interactive Rendering with Coherent Ray Tracing. 2001.

#include <array>
#include <cstring>

#include "raycast/packet/scan_packet.h"
#include "raycast/query/queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/packet/packet_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lanes-inl.h"
#include "raycast/packet/packet_hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
    // Sorts by counting the farther children. Bits of floats from 0 on are ordered as the floats are.
    const QI di;
    for (std::size_t i = 0; i < count; ++i) {
      const auto own = hn::Set(di, bits[i]);
      std::size_t rank = 0;
      for (std::size_t first = 0; first < count; first += kQueryLanes) {
        const auto others = hn::Load(di, bits + first);
        const auto used = hn::FirstN(di, count - first), before = hn::FirstN(di, i > first ? i - first : 0);
        rank += hn::CountTrue(di, hn::And(used, hn::Or(hn::Gt(others, own), hn::And(before, hn::Eq(others, own)))));
      }
      ScanScratch::Waiting& next = stack_[waiting_ + rank];
      std::memcpy(&next.place, &bits[i], sizeof next.place);
      next.child = child[i];
    }
    waiting_ += count;
  }

  const PacketCone& cone_;
  const RayTree& tree_;
  ScanScratch::Waiting* stack_;
  std::size_t waiting_ = 0;
  PacketHits hits_;
};

/// \returns false if the rays must be cast one by one.
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
