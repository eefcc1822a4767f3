// SPDX-License-Identifier: Apache-2.0
// The vertex formula of screen_transform.h for a vector of vertices at a time, with the same bits.
//
//   world --Transform--> X, Y, D before the divide --IsPlain--> lanes that can be --Snap--> 1/256 pixels and keys
//                                                       |
//                                                       +-----> all others are clipped one by one, see clip.h
//
// No step may be fused or reordered: a scalar loop also computes ((a*x + b*y) + c*z) + offset, and a vertex that two
// triangles share must get the same place whichever code draws each of them.

// Included once for every target.
#if defined(FRONTMOST_VIEW_SNAP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_VIEW_SNAP_INL_H_
#undef FRONTMOST_VIEW_SNAP_INL_H_
#else
#define FRONTMOST_VIEW_SNAP_INL_H_
#endif

#include "base/highway-inl.h"
#include "view/screen_transform.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::view_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using SnapF = hn::ScalableTag<float>;
using SnapI = hn::RebindToSigned<SnapF>;

/// Vertices before the divide.
struct HomogeneousVertices {
  hn::Vec<SnapF> x, y, d;
};

/// Vertices on the screen, in 1/256 pixel from the centre of the image.
struct ScreenVertices {
  hn::Vec<SnapI> x, y;
  hn::Vec<SnapF> key;
};

HWY_INLINE hn::Vec<SnapF> RowOf(const std::array<float, 3>& row, float offset, const hn::Vec<SnapF> from_eye[3]) {
  const SnapF d;
  const auto x = hn::Mul(hn::Set(d, row[0]), from_eye[0]), y = hn::Mul(hn::Set(d, row[1]), from_eye[1]);
  return hn::Add(hn::Add(hn::Add(x, y), hn::Mul(hn::Set(d, row[2]), from_eye[2])), hn::Set(d, offset));
}

HWY_INLINE HomogeneousVertices Transform(const ScreenTransform& t, hn::Vec<SnapF> x, hn::Vec<SnapF> y,
                                         hn::Vec<SnapF> z) {
  const SnapF d;
  const hn::Vec<SnapF> from_eye[3] = {hn::Sub(x, hn::Set(d, t.eye[0])), hn::Sub(y, hn::Set(d, t.eye[1])),
                                      hn::Sub(z, hn::Set(d, t.eye[2]))};
  return {RowOf(t.x_row, t.x_offset, from_eye), RowOf(t.y_row, t.y_offset, from_eye),
          RowOf(t.d_row, t.d_offset, from_eye)};
}

/// The lanes that can be snapped as they are; NaN cannot.
HWY_INLINE hn::Mask<SnapF> IsPlain(const ScreenTransform& t, const HomogeneousVertices& v) {
  const SnapF d;
  const auto guard = hn::Set(d, float(kGuardBand));
  const auto most = hn::Set(d, std::numeric_limits<float>::max());
  const auto reach = t.orthographic ? guard : hn::Min(hn::Mul(guard, v.d), most);
  const auto between = hn::And(hn::Ge(v.d, hn::Set(d, t.near)), hn::Le(v.d, hn::Set(d, t.far)));
  return hn::And(between, hn::And(hn::Le(hn::Abs(v.x), reach), hn::Le(hn::Abs(v.y), reach)));
}

/// Snaps vertices. The results are valid only in the lanes of IsPlain().
HWY_INLINE ScreenVertices Snap(const ScreenTransform& t, const HomogeneousVertices& v) {
  const SnapF d;
  const auto one = hn::Set(d, 1.0f);
  if (t.orthographic) {
    const auto key = hn::Mul(hn::Sub(hn::Set(d, t.far), v.d), hn::Set(d, t.inverse_range));
    return {hn::NearestInt(v.x), hn::NearestInt(v.y), hn::Min(hn::Max(key, hn::Zero(d)), one)};
  }
  const auto inverse = hn::Div(one, v.d);
  return {hn::NearestInt(hn::Mul(v.x, inverse)), hn::NearestInt(hn::Mul(v.y, inverse)),
          hn::Min(hn::Mul(hn::Set(d, t.near), inverse), one)};
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::view_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
