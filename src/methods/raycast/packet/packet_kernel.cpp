// SPDX-License-Identifier: Apache-2.0
// Casts a packet of a scan's rays through the tree: nearest boxes first, eight boxes or triangles at a time, for all
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
#include "base/compactor-inl.h"
#include "base/lanes-inl.h"
#include "base/wasm_lanes-inl.h"
#include "raycast/query/ray_axis-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using frontmost::HWY_NAMESPACE::Compactor;

/// How many of `count` are greater than number i, or equal and before it. Bits of floats from 0 on are ordered as the
/// floats are, even if they overflow to NaN.
HWY_INLINE std::size_t RankOf(const std::int32_t* at, std::size_t count, std::size_t i) {
  const QI d;
  const auto own = hn::Set(d, at[i]);
  std::size_t rank = 0;
  for (std::size_t first = 0; first < count; first += kQueryLanes) {
    const auto others = hn::Load(d, at + first);
    const auto used = hn::FirstN(d, count - first), before = hn::FirstN(d, i > first ? i - first : 0);
    rank += hn::CountTrue(d, hn::And(used, hn::Or(hn::Gt(others, own), hn::And(before, hn::Eq(others, own)))));
  }
  return rank;
}

// Finds the pyramid of a packet's rays, leaves out boxes and triangles that lie beside it, and prepares the other
// triangles for tests against rays.
//
//          u |      . high u        The axis z is the one that the rays move most along. Every ray is a point (u, v) of
//            |   .   /              the plane at z = 1, its slopes, and the packet is a rectangle of that plane. Boxes
//       eye  |.-----/------ z       and triangles are relative to the eye, and are compared with the rectangle at their
//              `   /                own distance. Everything left out lies beside it by more than all rounding.
//                `.  low u
//
// The turn of a ray about an edge tells on which side of the plane of the eye and the edge the ray passes. Turns are
// affine in the rays' slopes, so the turns of a whole rectangle of rays lie between those at its corners.

/// Blocks of a packet's rays in the order of the grid: the rays of a block are tested together.
constexpr std::size_t kBlockRays = 16, kScanBlocks = kScanRays / kBlockRays;

/// The range of the slopes of some neighbouring rays.
struct SlopeRange {
  float low_u, high_u, low_v, high_v;
};

/// Bound on the rounding error of coordinates of size 1: some roundings of up to three terms, and as much again.
constexpr float kConeError = 0x1p-20f;

class PacketCone {
 public:
  /// Takes the rays of a packet. \returns false if they spread too widely to be cast together.
  bool Take(const ScanPacket& packet) {
    origin_ = packet.origin;
    valid_ = ValidRays(packet);
    return valid_ != 0 && SetAxis(packet) && SetSlopes();
  }

  [[nodiscard]] int z_axis() const { return z_; }
  [[nodiscard]] int u_axis() const { return u_; }
  [[nodiscard]] int v_axis() const { return v_; }
  [[nodiscard]] float sign() const { return sign_; }
  /// A bit for each ray that has a direction.
  [[nodiscard]] std::uint64_t valid() const { return valid_; }
  /// An upper bound of the sizes of all slopes; at least 1.
  [[nodiscard]] float steepest() const { return steepest_; }
  [[nodiscard]] const SlopeRange& range() const { return range_; }
  [[nodiscard]] const SlopeRange& range(std::size_t block) const { return block_range_[block]; }
  [[nodiscard]] HWY_INLINE QV SlopesU(std::size_t ray) const { return hn::Load(QF(), slope_u_ + ray); }
  [[nodiscard]] HWY_INLINE QV SlopesV(std::size_t ray) const { return hn::Load(QF(), slope_v_ + ray); }

  /// Coordinates relative to the eye.
  [[nodiscard]] HWY_INLINE QV FromEye(const float* from, int axis) const {
    const QF d;
    return hn::Sub(hn::Load(d, from), hn::Set(d, origin_[axis]));
  }

  /// The boxes of a node that no ray meets before its block's end, and the least place along the axis that each box
  /// reaches.
  struct Missed {
    QM boxes;
    QV place;
  };
  [[nodiscard]] HWY_INLINE Missed Misses(const RayNode& node, std::size_t first, const float* ends) const {
    const QF d;
    QV low_z = FromEye((sign_ > 0 ? node.low : node.high)[z_] + first, z_);
    QV high_z = FromEye((sign_ > 0 ? node.high : node.low)[z_] + first, z_);
    if (sign_ < 0) low_z = hn::Neg(low_z), high_z = hn::Neg(high_z);
    const QV pad = hn::Mul(hn::Max(hn::Abs(low_z), hn::Abs(high_z)), hn::Set(d, kConeError));
    // The part of a box behind the eye is not met. The remaining part reaches from `near` to `far` along the axis.
    const QV near = hn::Max(hn::Sub(low_z, pad), hn::Zero(d)), far = hn::Add(high_z, pad);
    const Sides u = SidesOf(node, first, u_, near, far), v = SidesOf(node, first, v_, near, far);
    QM met = hn::MaskFromVec(hn::Zero(d));
    for (std::size_t block = 0; block < kScanBlocks; ++block) {
      const SlopeRange& r = block_range_[block];
      const QM beside = hn::Or(Beside(u, {r.low_u, r.high_u}), Beside(v, {r.low_v, r.high_v}));
      met = hn::Or(met, hn::Not(hn::Or(beside, hn::Gt(near, hn::Set(d, ends[block])))));
    }
    return {hn::Or(hn::Lt(far, hn::Zero(d)), hn::Not(met)), near};
  }

 private:
  /// Wider packets visit so much that single rays are quicker.
  static constexpr float kWidest = 0.75f;
  static constexpr float kSteepest = 4;

  struct Interval {
    float low, high;
  };

  /// The range of boxes across the axis, padded for rounding, and their places `near` to `far` along it.
  struct Sides {
    QV low, high, near, far;
  };
  [[nodiscard]] HWY_INLINE Sides SidesOf(const RayNode& node, std::size_t first, int axis, QV near, QV far) const {
    const QF d;
    const QV low = FromEye(node.low[axis] + first, axis), high = FromEye(node.high[axis] + first, axis);
    const QV across = hn::Max(hn::Abs(low), hn::Abs(high)), along = hn::Mul(far, hn::Set(d, steepest_));
    const QV pad = hn::Mul(hn::Max(across, along), hn::Set(d, kConeError));
    return {hn::Sub(low, pad), hn::Add(high, pad), near, far};
  }

  /// Returns the boxes beside the rays. At a place z between near and far, the rays lie between low * z and high * z.
  [[nodiscard]] HWY_INLINE QM Beside(const Sides& box, const Interval& slopes) const {
    const QF d;
    const QV least = hn::Mul(slopes.low >= 0 ? box.near : box.far, hn::Set(d, slopes.low));
    const QV most = hn::Mul(slopes.high >= 0 ? box.far : box.near, hn::Set(d, slopes.high));
    return hn::Or(hn::Gt(box.low, most), hn::Lt(box.high, least));
  }

  /// Returns a bit for each ray: whether is_valid() holds.
  [[nodiscard]] static std::uint64_t ValidRays(const ScanPacket& packet) {
    if (!is_finite(packet.origin)) return 0;
    const QF d;
    std::uint64_t valid = 0;
    for (std::size_t first = 0; first < kScanRays; first += kQueryLanes) {
      QV size = hn::Zero(d);
      QM finite = hn::FirstN(d, packet.count > first ? packet.count - first : 0);
      for (const auto& coordinates : packet.direction) {
        const QV coordinate = hn::Abs(hn::Load(d, coordinates + first));
        finite = hn::And(finite, hn::Lt(coordinate, hn::Set(d, kFloatInfinity)));
        size = hn::Max(size, coordinate);
      }
      const QM rays = hn::And(finite, hn::Gt(size, hn::Zero(d)));
      valid |= frontmost::HWY_NAMESPACE::BitsOf(d, rays) << first;
    }
    return valid;
  }

  /// Chooses the axis along which a middle ray moves most. \returns true if every ray moves forwards along it.
  bool SetAxis(const ScanPacket& packet) {
    const std::size_t lowest = hwy::Num0BitsBelowLS1Bit_Nonzero64(valid_), middle = packet.count / 2;
    const std::size_t some = valid_ >> middle & 1 ? middle : lowest;
    const glm::vec3 direction = packet.query_of(some).direction, size = glm::abs(direction);
    z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u_ = (z_ + 1) % 3, v_ = (z_ + 2) % 3;
    sign_ = direction[z_] < 0 ? -1.0f : 1.0f;
    // Unused rays are replaced by copies of a valid ray.
    const QF d;
    QM ahead = hn::FirstN(d, kQueryLanes);
    for (std::size_t first = 0; first < kScanRays; first += kQueryLanes) {
      std::uint8_t bits[8] = {std::uint8_t(valid_ >> first), std::uint8_t(valid_ >> first >> 8)};
      const QM is_own = hn::LoadMaskBits(d, bits);
      const auto coordinate = [&](int axis) HWY_ATTR {
        return hn::IfThenElse(is_own, hn::Load(d, packet.direction[axis] + first), hn::Set(d, direction[axis]));
      };
      const QV along = hn::Mul(coordinate(z_), hn::Set(d, sign_));
      ahead = hn::And(ahead, hn::Gt(along, hn::Zero(d)));
      hn::Store(hn::Div(coordinate(u_), along), d, slope_u_ + first);
      hn::Store(hn::Div(coordinate(v_), along), d, slope_v_ + first);
    }
    return hn::AllTrue(d, ahead);
  }

  bool SetSlopes() {
    range_ = block_range_[0] = RangeOf(0);
    for (std::size_t block = 1; block < kScanBlocks; ++block) {
      const SlopeRange r = block_range_[block] = RangeOf(block);
      range_ = {std::min(range_.low_u, r.low_u), std::max(range_.high_u, r.high_u), std::min(range_.low_v, r.low_v),
                std::max(range_.high_v, r.high_v)};
    }
    steepest_ = std::max({1.0f, -range_.low_u, range_.high_u, -range_.low_v, range_.high_v});
    // Also false for NaN slopes.
    return steepest_ <= kSteepest && range_.high_u - range_.low_u <= kWidest && range_.high_v - range_.low_v <= kWidest;
  }

  [[nodiscard]] HWY_INLINE SlopeRange RangeOf(std::size_t block) const {
    const QF d;
    QV low_u = SlopesU(block * kBlockRays), high_u = low_u, low_v = SlopesV(block * kBlockRays), high_v = low_v;
    for (std::size_t i = kQueryLanes; i < kBlockRays; i += kQueryLanes) {
      const QV u = SlopesU(block * kBlockRays + i), v = SlopesV(block * kBlockRays + i);
      low_u = hn::Min(low_u, u), high_u = hn::Max(high_u, u);
      low_v = hn::Min(low_v, v), high_v = hn::Max(high_v, v);
    }
    return {hn::GetLane(hn::MinOfLanes(d, low_u)), hn::GetLane(hn::MaxOfLanes(d, high_u)),
            hn::GetLane(hn::MinOfLanes(d, low_v)), hn::GetLane(hn::MaxOfLanes(d, high_v))};
  }

  glm::vec3 origin_{0};
  std::uint64_t valid_ = 0;
  int z_ = 2, u_ = 0, v_ = 1;
  float sign_ = 1, steepest_ = 1;
  SlopeRange range_{}, block_range_[kScanBlocks]{};
  alignas(64) float slope_u_[kScanRays], slope_v_[kScanRays];
};

/// The triangles of a leaf, laid out so that one triangle can be tested against a vector of rays.
struct PacketTriangles {
  alignas(64) float normal[3][3][kRayLanes];  ///< normals of the planes of the eye and an edge: [edge][u, v, z]; edge k
                                              ///< lies opposite vertex k
  alignas(64) float z[3][kRayLanes];          ///< vertices' places along the packet's axis
  alignas(64) float low_z[kRayLanes], high_z[kRayLanes];
  alignas(64) float bound[kRayLanes];  ///< error bound of all turns; infinite if floats do not suffice
  alignas(64) float error[kRayLanes];  ///< error bound of all places
  std::uint32_t blocks[kScanBlocks];   ///< triangles that the rays of a block may meet, a bit each
};

class TrianglePlacer {
 public:
  TrianglePlacer(const PacketCone& cone, const RayLeaf& leaf, PacketTriangles& to)
      : cone_(cone), leaf_(leaf), to_(to) {}

  /// Prepares a vector of triangles, and finds the blocks that may meet them. Triangles that begin beyond the `ends` of
  /// a block are not met. \returns the triangles that any block may meet.
  HWY_INLINE std::uint32_t Place(std::size_t first, const float* ends) {
    const QF d;
    QV at[3][3], low[3], high[3];
    PlaceCorners(first, at);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = hn::Min(hn::Min(at[0][axis], at[1][axis]), at[2][axis]);
      high[axis] = hn::Max(hn::Max(at[0][axis], at[1][axis]), at[2][axis]);
    }
    const QV size = hn::Max(hn::Max(Size(low[0], high[0]), Size(low[1], high[1])), Size(low[2], high[2]));
    // If products may leave the range of floats, the triangle counts as one that may be met anywhere.
    const QM serves = hn::Lt(size, hn::Set(d, 0x1p40f));
    const QV error = hn::IfThenElseZero(serves, hn::Mul(Size(low[2], high[2]), hn::Set(d, kConeError)));
    const QV all = hn::Set(d, kFloatInfinity);
    low[2] = hn::IfThenElse(serves, low[2], hn::Neg(all));
    high[2] = hn::IfThenElse(serves, high[2], all);
    hn::Store(low[2], d, to_.low_z + first);
    hn::Store(high[2], d, to_.high_z + first);
    hn::Store(error, d, to_.error + first);
    const QM used = hn::RebindMask(d, hn::Ne(hn::Load(QU(), leaf_.id + first), hn::Set(QU(), no_primitive)));
    const QM before = hn::AndNot(hn::Lt(hn::Add(high[2], error), hn::Zero(d)), used);
    if (PlaceOutlines(at, hn::Sub(low[2], error), before, ends) == 0) return 0;
    return LeaveOut(PlaceEdges(first, at, size, serves));
  }

 private:
  static HWY_INLINE QV Size(QV low, QV high) { return hn::Max(hn::Abs(low), hn::Abs(high)); }

  HWY_INLINE void PlaceCorners(std::size_t first, QV (&at)[3][3]) const {
    const QF d;
    for (int k = 0; k < 3; ++k) {
      at[k][0] = cone_.FromEye(leaf_.corner[k][cone_.u_axis()] + first, cone_.u_axis());
      at[k][1] = cone_.FromEye(leaf_.corner[k][cone_.v_axis()] + first, cone_.v_axis());
      const QV z = cone_.FromEye(leaf_.corner[k][cone_.z_axis()] + first, cone_.z_axis());
      at[k][2] = hn::Mul(z, hn::Set(d, cone_.sign()));
      hn::Store(at[k][2], d, to_.z[k] + first);
    }
  }

  /// Returns a coordinate of an edge as a difference of world coordinates, because this is rounded least.
  [[nodiscard]] HWY_INLINE QV EdgeAlong(std::size_t first, int from, int to, int axis) const {
    const QF d;
    return hn::Sub(hn::Load(d, leaf_.corner[to][axis] + first), hn::Load(d, leaf_.corner[from][axis] + first));
  }

  /// Prepares the edges. \returns the triangles that all rays of the packet miss, as Outside() finds them.
  HWY_INLINE QM PlaceEdges(std::size_t first, const QV (&at)[3][3], QV size, QM serves) const {
    const QF d;
    QV normal[3][3], longest = hn::Zero(d);
    for (int k = 0; k < 3; ++k) {
      const int from = (k + 1) % 3, to = (k + 2) % 3;
      const QV u = EdgeAlong(first, from, to, cone_.u_axis()), v = EdgeAlong(first, from, to, cone_.v_axis());
      const QV z = hn::Mul(EdgeAlong(first, from, to, cone_.z_axis()), hn::Set(d, cone_.sign()));
      const QV(&a)[3] = at[from];
      normal[k][0] = hn::Sub(hn::Mul(a[1], z), hn::Mul(a[2], v));
      normal[k][1] = hn::Sub(hn::Mul(a[2], u), hn::Mul(a[0], z));
      normal[k][2] = hn::Sub(hn::Mul(a[0], v), hn::Mul(a[1], u));
      for (int axis = 0; axis < 3; ++axis) hn::Store(normal[k][axis], d, to_.normal[k][axis] + first);
      longest = hn::Max(longest, hn::Max(hn::Max(hn::Abs(u), hn::Abs(v)), hn::Abs(z)));
    }
    // Let A be the largest coordinate, S the largest coordinate of an edge, and M the steepest slope. A turn is a sum
    // of three products of a slope and a difference of products. It is wrong by at most 42 half units in the last place
    // of A S M. The last term is for underflow.
    const QV scale = hn::Mul(hn::Mul(size, longest), hn::Set(d, cone_.steepest() * 0x1p-18f));
    const QV bound = hn::IfThenElse(serves, hn::Add(scale, hn::Set(d, 0x1p-100f)), hn::Set(d, kFloatInfinity));
    hn::Store(bound, d, to_.bound + first);
    return Outside(normal, bound);
  }

  /// Returns the triangles that all rays miss. If the sum of the turns has one sign for all rays, a ray meets the
  /// triangle only if every turn has this sign. So all rays miss it if the turns about one edge have the other sign.
  [[nodiscard]] HWY_INLINE QM Outside(const QV (&normal)[3][3], QV bound) const {
    const QF d;
    QV least = hn::Zero(d), most = hn::Zero(d);
    QM below = hn::MaskFromVec(hn::Zero(d)), above = below;
    for (int k = 0; k < 3; ++k) {
      const Range turn = TurnsOf(normal[k]);
      below = hn::Or(below, hn::Lt(turn.high, hn::Neg(bound)));
      above = hn::Or(above, hn::Gt(turn.low, bound));
      least = hn::Add(least, turn.low);
      most = hn::Add(most, turn.high);
    }
    const QV slack = hn::Mul(bound, hn::Set(d, 4.0f));
    return hn::Or(hn::And(below, hn::Gt(least, slack)), hn::And(above, hn::Lt(most, hn::Neg(slack))));
  }

  struct Range {
    QV low, high;
  };
  [[nodiscard]] HWY_INLINE Range TurnsOf(const QV (&normal)[3]) const {
    const QF d;
    const SlopeRange& r = cone_.range();
    const QV a = hn::Mul(normal[0], hn::Set(d, r.low_u)), b = hn::Mul(normal[0], hn::Set(d, r.high_u));
    const QV e = hn::Mul(normal[1], hn::Set(d, r.low_v)), f = hn::Mul(normal[1], hn::Set(d, r.high_v));
    return {hn::Add(normal[2], hn::Add(hn::Min(a, b), hn::Min(e, f))),
            hn::Add(normal[2], hn::Add(hn::Max(a, b), hn::Max(e, f)))};
  }

  /// Finds the rectangle of slopes of each triangle in front of the eye, and the blocks of rays that meet this
  /// rectangle. \returns the triangles that any block may meet.
  HWY_INLINE std::uint32_t PlaceOutlines(const QV (&at)[3][3], QV nearest, QM kept, const float* ends) const {
    const QF d;
    const QV one = hn::Set(d, 1.0f);
    const QV big = hn::Set(d, 0x1p60f);
    QV low_u = big, low_v = big, high_u = hn::Neg(big), high_v = high_u;
    for (int k = 0; k < 3; ++k) {
      const QV inverse = hn::Div(one, at[k][2]);
      const QV u = hn::Mul(at[k][0], inverse), v = hn::Mul(at[k][1], inverse);
      low_u = hn::Min(low_u, u), high_u = hn::Max(high_u, u);
      low_v = hn::Min(low_v, v), high_v = hn::Max(high_v, v);
    }
    const QM before = hn::Gt(nearest, hn::Set(d, 0x1p-40f));
    const auto pad = [&](QV low, QV high) HWY_ATTR { return hn::Mul(Size(low, high), hn::Set(d, kConeError)); };
    const QV pad_u = pad(low_u, high_u), pad_v = pad(low_v, high_v);
    low_u = hn::Sub(low_u, pad_u), high_u = hn::Add(high_u, pad_u);
    low_v = hn::Sub(low_v, pad_v), high_v = hn::Add(high_v, pad_v);
    std::uint32_t any = 0;
    for (std::size_t block = 0; block < kScanBlocks; ++block) {
      const SlopeRange& r = cone_.range(block);
      const QM beside_u = hn::Or(hn::Gt(low_u, hn::Set(d, r.high_u)), hn::Lt(high_u, hn::Set(d, r.low_u)));
      const QM beside_v = hn::Or(hn::Gt(low_v, hn::Set(d, r.high_v)), hn::Lt(high_v, hn::Set(d, r.low_v)));
      const QM missed = hn::Or(hn::And(before, hn::Or(beside_u, beside_v)), hn::Gt(nearest, hn::Set(d, ends[block])));
      const auto bits = std::uint32_t(frontmost::HWY_NAMESPACE::BitsOf(d, hn::AndNot(missed, kept)));
      any |= to_.blocks[block] = bits;
    }
    return any;
  }

  /// Removes triangles from all blocks. \returns the remaining triangles.
  HWY_INLINE std::uint32_t LeaveOut(QM triangles) const {
    const auto kept = ~std::uint32_t(frontmost::HWY_NAMESPACE::BitsOf(QF(), triangles));
    std::uint32_t any = 0;
    for (std::uint32_t& block : to_.blocks) any |= block &= kept;
    return any;
  }

  const PacketCone& cone_;
  const RayLeaf& leaf_;
  PacketTriangles& to_;
};

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
