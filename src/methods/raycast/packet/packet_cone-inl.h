// SPDX-License-Identifier: Apache-2.0
// The pyramid of a packet's rays, and which boxes and triangles lie beside it.
//
//          u |      . high u        The axis z is the one that the rays move most along. Every ray is a point (u, v) of
//            |   .   /              the plane at z = 1, its slopes, and the packet is a rectangle of that plane. Boxes
//       eye  |.-----/------ z       and triangles are relative to the eye, and are compared with the rectangle at their
//              `   /                own distance. Everything left out lies beside it by more than all rounding.
//                `.  low u

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_PACKET_CONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_PACKET_CONE_INL_H_
#undef FRONTMOST_RAYCAST_PACKET_CONE_INL_H_
#else
#define FRONTMOST_RAYCAST_PACKET_CONE_INL_H_
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

/// Slopes of neighbouring rays.
struct SlopeRange {
  float low_u, high_u, low_v, high_v;
};

/// Bound of the rounding of a unit: some roundings of each of up to three terms, and as much again.
constexpr float kConeError = 0x1p-20f;

class PacketCone {
 public:
  /// \returns false if the rays spread too widely to be cast together.
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
  /// An upper bound of all slopes, and at least 1.
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

  /// Boxes of a node that no ray meets before its block's end, and the least place that each box reaches.
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
    // Parts behind the eye are not met; the place of the remaining part tells where it begins along the axis.
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

  /// Boxes beside the rays: between near and far along the axis the rays lie between low * z and high * z.
  [[nodiscard]] HWY_INLINE QM Beside(const Sides& box, const Interval& slopes) const {
    const QF d;
    const QV least = hn::Mul(slopes.low >= 0 ? box.near : box.far, hn::Set(d, slopes.low));
    const QV most = hn::Mul(slopes.high >= 0 ? box.far : box.near, hn::Set(d, slopes.high));
    return hn::Or(hn::Gt(box.low, most), hn::Lt(box.high, least));
  }

  /// is_valid(), a bit for each ray.
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

  /// Takes the greatest coordinate of a middle ray as the axis. \returns true if every ray moves forwards along it.
  bool SetAxis(const ScanPacket& packet) {
    const std::size_t lowest = hwy::Num0BitsBelowLS1Bit_Nonzero64(valid_), middle = packet.count / 2;
    const std::size_t some = valid_ >> middle & 1 ? middle : lowest;
    const glm::vec3 direction = packet.query_of(some).direction, size = glm::abs(direction);
    z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u_ = (z_ + 1) % 3, v_ = (z_ + 2) % 3;
    sign_ = direction[z_] < 0 ? -1.0f : 1.0f;
    // Unused rays take the place of a valid ray.
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

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
