// SPDX-License-Identifier: Apache-2.0
// Eight rays at once against a piece of a patch or a box.
//
// Every lane does what patch_search.cpp does for a single ray, operation by operation in the same order, so that the
// answers are equal to the bit with any instruction set. What is left out is halving: neighbouring rays rarely need it
// at the same place, and those that do are asked one by one.
//
//    lanes asked --hull holds the ray?--> --Jacobian has an inverse, and it contracts?--> step to the root, all lanes
//                     no: missed                     no: open, asked alone                together until none is left
//
// A lane that is done keeps its answer by masks while others step on; steps of lanes that are done change nothing.
#include "raycast/curved/patch_packet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/curved/patch_packet_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After base/highway-inl.h, for each target.
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::BitsOf;

using PD = hn::CappedTag<double, kPacketRays>;
using PV = hn::Vec<PD>;
using PM = hn::Mask<PD>;
constexpr std::size_t kLanes = hn::MaxLanes(PD());

HWY_INLINE PV LoadLanes(const PacketLanes& lanes, std::size_t first) { return hn::Load(PD(), lanes.data() + first); }

struct Vector {
  PV x, y, z;
};

HWY_INLINE Vector LoadLanes(const PacketVectors& v, std::size_t first) {
  return {LoadLanes(v.x, first), LoadLanes(v.y, first), LoadLanes(v.z, first)};
}

HWY_INLINE PV Dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

struct Vector2 {
  PV x, y;
};

HWY_INLINE Vector2 Minus(const Vector2& a, const Vector2& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)}; }
HWY_INLINE Vector2 Plus(const Vector2& a, const Vector2& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y)}; }
HWY_INLINE Vector2 Times(const Vector2& a, PV s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s)}; }

/// As many rays as a vector has lanes, against one piece.
class LanesOnPiece {
 public:
  LanesOnPiece(const PatchPiece& piece, const RayPacket& rays, std::size_t first) {
    const Vector origin = LoadLanes(rays.origin, first), across_x = LoadLanes(rays.across_x, first),
                 across_y = LoadLanes(rays.across_y, first), along = LoadLanes(rays.along, first);
    const PD d;
    PV reach = hn::Zero(d);
    low_ = {hn::Set(d, kInfinity), hn::Set(d, kInfinity), hn::Set(d, kInfinity)};
    high_ = {hn::Set(d, -kInfinity), hn::Set(d, -kInfinity), hn::Set(d, -kInfinity)};
    for (std::size_t i = 0; i < 16; ++i) {
      const glm::dvec3& p = piece.patch.points[i];
      const Vector from_origin{hn::Sub(hn::Set(d, p.x), origin.x), hn::Sub(hn::Set(d, p.y), origin.y),
                               hn::Sub(hn::Set(d, p.z), origin.z)};
      net_[i] = {Dot(across_x, from_origin), Dot(across_y, from_origin)};
      depth_[i] = Dot(along, from_origin);
      low_ = {hn::Min(low_.x, net_[i].x), hn::Min(low_.y, net_[i].y), hn::Min(low_.z, depth_[i])};
      high_ = {hn::Max(high_.x, net_[i].x), hn::Max(high_.y, net_[i].y), hn::Max(high_.z, depth_[i])};
    }
    for (const PV side : {low_.x, low_.y, low_.z, high_.x, high_.y, high_.z}) reach = hn::Max(reach, hn::Abs(side));
    const PV finest =
        hn::Max(hn::Add(hn::Set(d, piece.scale * kFinestPart), hn::Mul(reach, hn::Set(d, kFinestPartOfReach))),
                hn::Set(d, kFinest));
    finest_ = finest;
    pad_ = hn::Mul(finest, hn::Set(d, kPad));
    nearest_ = LoadLanes(rays.nearest, first);
    farthest_ = LoadLanes(rays.farthest, first);
  }

  /// Those whose ray the hull does not hold.
  [[nodiscard]] PM ClearOfHull() const {
    const PV minus_pad = hn::Neg(pad_);
    const PM beside = hn::Or(hn::Or(hn::Gt(low_.x, pad_), hn::Lt(high_.x, minus_pad)),
                             hn::Or(hn::Gt(low_.y, pad_), hn::Lt(high_.y, minus_pad)));
    return hn::Or(beside, hn::Or(hn::Gt(low_.z, farthest_), hn::Lt(high_.z, nearest_)));
  }

  /// Of the `asked`, those that must be halved; others are met in `met`, or not at all.
  [[nodiscard]] PM Settle(PM asked, PM& met) {
    const PD d;
    const PV size = hn::Max(hn::Sub(high_.x, low_.x), hn::Max(hn::Sub(high_.y, low_.y), hn::Sub(high_.z, low_.z)));
    const PM regular = hn::And(hn::Gt(size, finest_), Precondition());
    PM left = hn::And(asked, regular);
    const PV tolerance = hn::Mul(pad_, system_reach_);
    left = hn::AndNot(OutsideSystem(tolerance), left);
    const PV rate = Departure();
    const PM contracts = hn::Le(rate, hn::Set(d, kContracting));
    const PM open = hn::Or(hn::AndNot(regular, asked), hn::AndNot(contracts, left));
    left = hn::And(left, contracts);
    met = hn::AllFalse(d, left) ? left : StepToRoot(left, rate, tolerance);
    return open;
  }

  Vector2 at;   ///< of the met, in the piece
  PV distance;  ///< along the ray

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// \returns where the mean Jacobian has an inverse.
  PM Precondition() {
    const PD d;
    const PV quarter = hn::Set(d, 0.25);
    Vector2 u{hn::Zero(d), hn::Zero(d)}, v = u;
    for (std::size_t k = 0; k < 4; ++k) {
      u = Plus(u, Times(Minus(net_[12 + k], net_[k]), quarter));
      v = Plus(v, Times(Minus(net_[4 * k + 3], net_[4 * k]), quarter));
    }
    const PV determinant = hn::Sub(hn::Mul(u.x, v.y), hn::Mul(u.y, v.x));
    const PV product = hn::Mul(Length(u), Length(v));
    column0_ = {hn::Div(v.y, determinant), hn::Div(hn::Neg(u.y), determinant)};
    column1_ = {hn::Div(hn::Neg(v.x), determinant), hn::Div(u.x, determinant)};
    for (std::size_t i = 0; i < 16; ++i) system_[i] = Solve(net_[i]);
    system_reach_ =
        hn::Max(hn::Add(hn::Abs(column0_.x), hn::Abs(column1_.x)), hn::Add(hn::Abs(column0_.y), hn::Abs(column1_.y)));
    return hn::Gt(hn::Abs(determinant), hn::Mul(product, hn::Set(d, kSingular)));
  }

  static PV Length(const Vector2& v) { return hn::Sqrt(hn::Add(hn::Mul(v.x, v.x), hn::Mul(v.y, v.y))); }

  [[nodiscard]] Vector2 Solve(const Vector2& p) const {
    return {hn::Add(hn::Mul(column0_.x, p.x), hn::Mul(column1_.x, p.y)),
            hn::Add(hn::Mul(column0_.y, p.x), hn::Mul(column1_.y, p.y))};
  }

  [[nodiscard]] PM OutsideSystem(PV tolerance) const {
    Vector2 low = system_[0], high = low;
    for (std::size_t i = 1; i < 16; ++i) {
      low = {hn::Min(low.x, system_[i].x), hn::Min(low.y, system_[i].y)};
      high = {hn::Max(high.x, system_[i].x), hn::Max(high.y, system_[i].y)};
    }
    const PV below = hn::Neg(tolerance);
    return hn::Or(hn::Or(hn::Gt(low.x, tolerance), hn::Gt(low.y, tolerance)),
                  hn::Or(hn::Lt(high.x, below), hn::Lt(high.y, below)));
  }

  [[nodiscard]] PV Departure() const {
    const PD d;
    const PV three = hn::Set(d, 3.0), one = hn::Set(d, 1.0), zero = hn::Zero(d);
    Vector2 most_u{zero, zero}, most_v{zero, zero};
    for (std::size_t line = 0; line < 4; ++line)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t u = 4 * k + line, v = 4 * line + k;
        const Vector2 by_u = Times(Minus(system_[u + 4], system_[u]), three);
        const Vector2 by_v = Times(Minus(system_[v + 1], system_[v]), three);
        most_u = {hn::Max(most_u.x, hn::Abs(hn::Sub(by_u.x, one))), hn::Max(most_u.y, hn::Abs(by_u.y))};
        most_v = {hn::Max(most_v.x, hn::Abs(by_v.x)), hn::Max(most_v.y, hn::Abs(hn::Sub(by_v.y, one)))};
      }
    return hn::Max(hn::Add(most_u.x, most_v.x), hn::Add(most_u.y, most_v.y));
  }

  struct Weights {
    PV w[4];
  };

  static Weights Bernstein(PV t) {
    const PD d;
    const PV a = hn::Sub(hn::Set(d, 1.0), t), three_a = hn::Mul(hn::Set(d, 3.0), a);
    return {{hn::Mul(hn::Mul(a, a), a), hn::Mul(hn::Mul(three_a, a), t), hn::Mul(hn::Mul(three_a, t), t),
             hn::Mul(hn::Mul(t, t), t)}};
  }

  template <class At>
  static PV Blend(const Weights& u, const Weights& v, const At& value) {
    PV sum = hn::Zero(PD());
    for (std::size_t i = 0; i < 4; ++i) {
      PV row = hn::Mul(value(4 * i), v.w[0]);
      for (std::size_t j = 1; j < 4; ++j) row = hn::Add(row, hn::Mul(value(4 * i + j), v.w[j]));
      sum = hn::Add(sum, hn::Mul(row, u.w[i]));
    }
    return sum;
  }

  PM StepToRoot(PM left, PV rate, PV tolerance) {
    const PD d;
    const PV zero = hn::Zero(d), one = hn::Set(d, 1.0), enough = hn::Mul(pad_, hn::Set(d, kNearEnough));
    Vector2 p{hn::Set(d, 0.5), hn::Set(d, 0.5)};
    PV bound = hn::Set(d, 0.5);
    PM met = hn::Lt(one, zero);
    at = p, distance = zero;
    for (int step = 0; step < kMostSteps; ++step) {
      const Weights u = Bernstein(p.x), v = Bernstein(p.y);
      const Vector2 value{Blend(u, v, [&](std::size_t i) { return net_[i].x; }),
                          Blend(u, v, [&](std::size_t i) { return net_[i].y; })};
      const Vector2 off = Solve(value);
      const PV size = hn::Max(hn::Abs(off.x), hn::Abs(off.y));
      left = hn::AndNot(hn::Gt(size, hn::Add(hn::Mul(hn::Add(one, rate), bound), tolerance)), left);
      const PV beside = hn::Max(hn::Abs(value.x), hn::Abs(value.y));
      const PM done = hn::And(left, hn::Or(hn::Le(beside, enough), hn::Lt(bound, hn::Set(d, kThere))));
      if (!hn::AllFalse(d, done)) {
        const PM there = hn::And(done, hn::Le(beside, pad_));
        met = hn::Or(met, there);
        at = {hn::IfThenElse(there, p.x, at.x), hn::IfThenElse(there, p.y, at.y)};
        distance = hn::IfThenElse(there, Blend(u, v, [&](std::size_t i) { return depth_[i]; }), distance);
        left = hn::AndNot(done, left);
      }
      if (hn::AllFalse(d, left)) break;
      p = {hn::Min(hn::Max(hn::Sub(p.x, off.x), zero), one), hn::Min(hn::Max(hn::Sub(p.y, off.y), zero), one)};
      bound = hn::Mul(bound, rate);
    }
    return hn::And(met, hn::And(hn::Ge(distance, nearest_), hn::Le(distance, farthest_)));
  }

  Vector2 net_[16];
  PV depth_[16];
  Vector low_, high_;
  PV finest_, pad_, nearest_, farthest_;
  Vector2 system_[16];
  Vector2 column0_, column1_;
  PV system_reach_;
};

void MeetPieceLanes(const PatchPiece& piece, const RayPacket& rays, std::uint32_t lanes, PieceMeetings& out) {
  const PD d;
  out.met = out.open = 0;
  for (std::size_t first = 0; first < kPacketRays; first += kLanes) {
    const std::uint32_t wanted = lanes >> first & ((1u << kLanes) - 1);
    if (wanted == 0) continue;
    LanesOnPiece on(piece, rays, first);
    const auto held = std::uint32_t(wanted & ~BitsOf(d, on.ClearOfHull()));
    if (held == 0) continue;
    PM met;
    const PM open = on.Settle(hn::Lt(hn::Zero(d), hn::Set(d, 1.0)), met);
    out.open |= (held & std::uint32_t(BitsOf(d, open))) << first;
    out.met |= (held & std::uint32_t(BitsOf(d, met))) << first;
    hn::Store(on.at.x, d, out.u.data() + first);
    hn::Store(on.at.y, d, out.v.data() + first);
    hn::Store(on.distance, d, out.distance.data() + first);
  }
}

/// As BoxTree::entry().
BoxEntry EnterBoxLanes(const DoubleBox& box, const RayPacket& rays, std::uint32_t lanes) {
  const PD d;
  BoxEntry entry{0, std::numeric_limits<double>::infinity()};
  const auto narrow = [&](double low, double high, PV origin, PV inverse, PV& enters, PV& leaves) {
    const PV a = hn::Mul(hn::Sub(hn::Set(d, low), origin), inverse),
             b = hn::Mul(hn::Sub(hn::Set(d, high), origin), inverse);
    const PM is_swapped = hn::Gt(a, b);
    const PV near = hn::IfThenElse(is_swapped, b, a);
    const PV far = hn::Mul(hn::IfThenElse(is_swapped, a, b), hn::Set(d, DoubleBoxTree::kRoundings));
    enters = hn::IfThenElse(hn::Gt(near, enters), near, enters);
    leaves = hn::IfThenElse(hn::Lt(far, leaves), far, leaves);
  };
  for (std::size_t first = 0; first < kPacketRays; first += kLanes) {
    const std::uint32_t wanted = lanes >> first & ((1u << kLanes) - 1);
    if (wanted == 0) continue;
    const Vector origin = LoadLanes(rays.origin, first), inverse = LoadLanes(rays.inverse, first);
    PV enters = LoadLanes(rays.from, first), leaves = LoadLanes(rays.to, first);
    narrow(box.low.x, box.high.x, origin.x, inverse.x, enters, leaves);
    narrow(box.low.y, box.high.y, origin.y, inverse.y, enters, leaves);
    narrow(box.low.z, box.high.z, origin.z, inverse.z, enters, leaves);
    const auto passed = std::uint32_t(wanted & BitsOf(d, hn::Le(enters, leaves)));
    if (passed == 0) continue;
    entry.lanes |= passed << first;
    alignas(64) double at[kLanes];
    hn::Store(enters, d, at);
    for (std::uint32_t left = passed; left != 0; left &= left - 1)
      entry.at = std::min(entry.at, at[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)]);
  }
  return entry;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(MeetPieceLanes);
FRONTMOST_KERNELS(EnterBoxLanes);

MeetPiece piece_kernel(Isa isa) { return kernel_for(MeetPieceLanesKernels, isa); }
EnterBox box_kernel(Isa isa) { return kernel_for(EnterBoxLanesKernels, isa); }

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
