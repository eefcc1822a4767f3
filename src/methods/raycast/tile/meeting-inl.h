// SPDX-License-Identifier: Apache-2.0
// The test of sample_rule.h in vectors: which rays meet which triangles, many at a time.
//
// A product of two floats is rounded monotonically. If two rounded products differ, their exact values differ in the
// same direction; only equal products leave a doubt. Doubtful lanes are decided one by one by the rule itself. They are
// few, on edges that pass exactly through samples.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_MEETING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_MEETING_INL_H_
#undef FRONTMOST_RAYCAST_MEETING_INL_H_
#else
#define FRONTMOST_RAYCAST_MEETING_INL_H_
#endif

#include "raycast/tile/tile_buffer-inl.h"
#include "view/facing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using view_detail::HWY_NAMESPACE::Kept;

/// Lanes in which the three determinants are certain. Floats round products monotonically, so a difference has the
/// right sign unless it is zero.
struct EdgeSides {
  MF front, back, doubtful;
};

HWY_INLINE EdgeSides SidesOf(const VF (&x)[3], const VF (&y)[3]) {
  const DF d;
  const VF u = hn::Sub(hn::Mul(x[1], y[2]), hn::Mul(y[1], x[2]));
  const VF v = hn::Sub(hn::Mul(x[2], y[0]), hn::Mul(y[2], x[0]));
  const VF w = hn::Sub(hn::Mul(x[0], y[1]), hn::Mul(y[0], x[1]));
  const VF zero = hn::Zero(d);
  const VF least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
  const VF closest = hn::Min(hn::Min(hn::Abs(u), hn::Abs(v)), hn::Abs(w));
  return {hn::Lt(most, zero), hn::Gt(least, zero), hn::Eq(closest, zero)};
}

/// Decides the doubtful lanes one by one with `meets(lane, sx, sy)`.
template <class Meets>
HWY_NOINLINE MF Resolve(MF met, MF doubtful, VF sx, VF sy, Meets&& meets) {
  const DF d;
  const DI di;
  alignas(64) float x[kLanes], y[kLanes];
  alignas(64) std::int32_t answer[kLanes];
  hn::Store(sx, d, x);
  hn::Store(sy, d, y);
  hn::Store(hn::VecFromMask(di, hn::RebindMask(di, met)), di, answer);
  ForEachBit(BitsOf(d, doubtful), [&](std::size_t lane) { answer[lane] = meets(lane, x[lane], y[lane]) ? -1 : 0; });
  return hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, answer)));
}

/// key_of_distance()
HWY_INLINE VF KeyOfDistance(const ScreenTransform& t, VF distance) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  if (!t.orthographic) return hn::Min(hn::Mul(hn::Set(d, t.near), hn::Div(one, distance)), one);
  const VF key = hn::Mul(hn::Sub(hn::Set(d, t.far), distance), hn::Set(d, t.inverse_range));
  return hn::Min(hn::Max(key, hn::Zero(d)), one);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
