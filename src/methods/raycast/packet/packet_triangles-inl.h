// SPDX-License-Identifier: Apache-2.0
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

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#undef FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#else
#define FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "base/highway-inl.h"
#include "raycast/packet/scan_packet.h"
#include "raycast/query/ray_axis-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
