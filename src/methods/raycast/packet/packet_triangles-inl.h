// SPDX-License-Identifier: Apache-2.0
// Sixteen triangles in the form that a packet of rays tests: the planes through the eye and each edge, and their
// outlines.
//
//         b            Relative to the eye, n = a x (b - a) is normal to the plane of the eye and the edge from a to b.
//        / \           The sign of n . ray tells on which side of the plane a ray passes. A ray that passes all three
//       a---c          edges on one side meets the triangle, at the mean of the vertices weighted by these values.
//
// These values, called turns, are affine in the rays' slopes. So the turns of a whole rectangle of rays lie between
// those at its corners. All is computed in floats, with a bound on the rounding.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#undef FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#else
#define FRONTMOST_RAYCAST_PACKET_TRIANGLES_INL_H_
#endif

#include "base/highway-inl.h"
#include "raycast/packet/packet_cone-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The triangles of a leaf, laid out for broadcasting to rays.
struct PacketTriangles {
  alignas(64) float normal[3][3][kRayLanes];  ///< [edge][u, v, z]; edge k lies opposite vertex k
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

  /// Places a vector of triangles, and finds which blocks, whose farthest ends are `ends`, may meet them. \returns the
  /// triangles that any block may meet.
  HWY_INLINE std::uint32_t Place(std::size_t first, const float* ends) {
    const QF d;
    QV at[3][3], low[3], high[3];
    PlaceCorners(first, at);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = hn::Min(hn::Min(at[0][axis], at[1][axis]), at[2][axis]);
      high[axis] = hn::Max(hn::Max(at[0][axis], at[1][axis]), at[2][axis]);
    }
    const QV size = hn::Max(hn::Max(Size(low[0], high[0]), Size(low[1], high[1])), Size(low[2], high[2]));
    // If products may leave the range of floats, the triangle may be met anywhere.
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

  /// The edge is a difference of world coordinates, where it is rounded least.
  [[nodiscard]] HWY_INLINE QV EdgeAlong(std::size_t first, int from, int to, int axis) const {
    const QF d;
    return hn::Sub(hn::Load(d, leaf_.corner[to][axis] + first), hn::Load(d, leaf_.corner[from][axis] + first));
  }

  /// \returns the triangles that all rays of the packet pass on the outer side of an edge.
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
    // With A the largest coordinate, S the longest edge's and M the steepest slope, a turn is a sum of three products
    // of slopes and differences of products. It is wrong by at most 42 half units in the last place of A S M. The last
    // term stands for underflow.
    const QV scale = hn::Mul(hn::Mul(size, longest), hn::Set(d, cone_.steepest() * 0x1p-18f));
    const QV bound = hn::IfThenElse(serves, hn::Add(scale, hn::Set(d, 0x1p-100f)), hn::Set(d, kFloatInfinity));
    hn::Store(bound, d, to_.bound + first);
    return Outside(normal, bound);
  }

  /// If the sum of the turns has one sign for all rays, so has every turn of a ray that meets the triangle.
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

  /// Finds the slopes' rectangle of each triangle before the eye, and the blocks that meet the rectangle.
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

  /// \returns the remaining triangles.
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
