// SPDX-License-Identifier: Apache-2.0
// Key planes of small triangles (KeyPlane of triangle_keys.h), a vector of triangles at a time: the same operations,
// and so the same bits.
//
// Only the gradients need doubles. They are computed half a vector at a time, through memory, as a vector of doubles
// has half as many lanes.

// Included once for every target.
#if defined(FRONTMOST_VIEW_KEY_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_VIEW_KEY_PLANES_INL_H_
#undef FRONTMOST_VIEW_KEY_PLANES_INL_H_
#else
#define FRONTMOST_VIEW_KEY_PLANES_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lane_types-inl.h"
#include "view/triangle_keys.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::view_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

struct KeyPlanes {
  VI x0, y0;  ///< the topmost vertex
  VF k0, gx, gy, k_min, k_max;
  MI steep;  ///< steep triangles, which are drawn one by one; see SteepKeys
};

/// The sides of triangles from vertex 0 to vertex 1, and from vertex 2 to vertex 0.
struct TwoSides {
  VI x1, y1, x2, y2;
};

/// Finds the gradients in doubles, rounded once, as many lanes at a time as a vector of doubles has.
HWY_INLINE void FindGradients(const TwoSides& sides, const VF (&key)[3], KeyPlanes& planes) {
  using DD = hn::ScalableTag<double>;
  const DD d;
  const DI di;
  const hn::Rebind<float, DD> half_f;
  const hn::Rebind<std::int32_t, DD> half_i;
  HWY_ALIGN_MAX std::int32_t x1[kMaxLanes], y1[kMaxLanes], x2[kMaxLanes], y2[kMaxLanes], area[kMaxLanes];
  HWY_ALIGN_MAX float k[3][kMaxLanes], gx[kMaxLanes], gy[kMaxLanes];
  hn::Store(sides.x1, di, x1);
  hn::Store(sides.y1, di, y1);
  hn::Store(sides.x2, di, x2);
  hn::Store(sides.y2, di, y2);
  hn::Store(hn::Sub(hn::Mul(sides.x2, sides.y1), hn::Mul(sides.x1, sides.y2)), di, area);
  for (int c = 0; c < 3; ++c) hn::Store(key[c], DF(), k[c]);
  for (std::size_t i = 0; i < hn::Lanes(DF()); i += hn::Lanes(d)) {
    const auto wide_i = [&](const std::int32_t* from) HWY_ATTR { return hn::PromoteTo(d, hn::Load(half_i, from + i)); };
    const auto wide_f = [&](const float* from) HWY_ATTR { return hn::PromoteTo(d, hn::Load(half_f, from + i)); };
    const auto k0 = wide_f(k[0]), k1 = hn::Sub(wide_f(k[1]), k0), k2 = hn::Sub(wide_f(k[2]), k0);
    const auto scale = hn::Div(hn::Set(d, 1.0), wide_i(area));
    // The second side runs the other way, which changes the sign of its products.
    const auto across = hn::Neg(hn::Add(hn::Mul(k1, wide_i(y2)), hn::Mul(k2, wide_i(y1))));
    const auto down = hn::Add(hn::Mul(k2, wide_i(x1)), hn::Mul(k1, wide_i(x2)));
    hn::Store(hn::DemoteTo(half_f, hn::Mul(across, scale)), half_f, gx + i);
    hn::Store(hn::DemoteTo(half_f, hn::Mul(down, scale)), half_f, gy + i);
  }
  planes.gx = hn::Load(DF(), gx);
  planes.gy = hn::Load(DF(), gy);
}

/// Precondition: vertices less than 2^15 apart, areas positive.
HWY_INLINE KeyPlanes KeyPlanesOf(const VI (&x)[3], const VI (&y)[3], const VF (&key)[3]) {
  const DF df;
  const TwoSides sides{hn::Sub(x[1], x[0]), hn::Sub(y[1], y[0]), hn::Sub(x[0], x[2]), hn::Sub(y[0], y[2])};
  KeyPlanes planes;
  FindGradients(sides, key, planes);
  // Chooses the topmost vertex, or the left one of two at the same height. The distances of vertices 1 and 2 from
  // vertex 0 in reading order fit into 32 bits.
  const VI zero = hn::Zero(DI());
  const VI to_1 = hn::Add(hn::ShiftLeft<16>(sides.y1), sides.x1);
  const VI to_2 = hn::Neg(hn::Add(hn::ShiftLeft<16>(sides.y2), sides.x2));
  const MI is_1 = hn::Lt(to_1, zero), is_2 = hn::Lt(to_2, hn::Min(to_1, zero));
  const auto top = [&](const VI(&of)[3])
                       HWY_ATTR { return hn::IfThenElse(is_2, of[2], hn::IfThenElse(is_1, of[1], of[0])); };
  planes.x0 = top(x);
  planes.y0 = top(y);
  planes.k0 =
      hn::IfThenElse(hn::RebindMask(df, is_2), key[2], hn::IfThenElse(hn::RebindMask(df, is_1), key[1], key[0]));
  planes.k_min = hn::Min(key[0], hn::Min(key[1], key[2]));
  planes.k_max = hn::Max(key[0], hn::Max(key[1], key[2]));
  const auto extent = [&](const VI(&of)[3]) HWY_ATTR {
    const VI most = hn::Max(of[0], hn::Max(of[1], of[2])), least = hn::Min(of[0], hn::Min(of[1], of[2]));
    return hn::ConvertTo(df, hn::Sub(most, least));
  };
  const VF change = hn::Add(hn::Mul(hn::Abs(planes.gx), extent(x)), hn::Mul(hn::Abs(planes.gy), extent(y)));
  const VF limit = hn::Sub(planes.k_min, hn::Set(df, KeyPlane::least_key)), twice = hn::Add(limit, limit);
  const auto steep = hn::Or(hn::Gt(change, hn::Add(twice, twice)), hn::Gt(hn::Sub(planes.k_max, planes.k_min), twice));
  planes.steep = hn::RebindMask(DI(), steep);
  return planes;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::view_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
