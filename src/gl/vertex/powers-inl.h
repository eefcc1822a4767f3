// SPDX-License-Identifier: Apache-2.0
// Logarithms, powers and exponentials of floats with the same bits on every machine, to within some 2^-20.

// Included once for every target.
#if defined(FRONTMOST_GL_POWERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_GL_POWERS_INL_H_
#undef FRONTMOST_GL_POWERS_INL_H_
#else
#define FRONTMOST_GL_POWERS_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

/// Base 2. Precondition: x is positive and normal.
HWY_INLINE VF Log2(VF x) {
  const DF df;
  const DI di;
  // x = m * 2^e with m in [sqrt(1/2), sqrt(2)); log(m) = 2 atanh((m - 1) / (m + 1)).
  const VI bits = hn::BitCast(di, x);
  const VI e = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3F3504F3)));
  const VF m = hn::BitCast(df, hn::Sub(bits, hn::ShiftLeft<23>(e)));
  const VF t = hn::Div(hn::Sub(m, All(1)), hn::Add(m, All(1))), tt = hn::Mul(t, t);
  VF sum = hn::Add(hn::Mul(tt, All(0.4121985831f)), All(0.5770780164f));  // 2 / (7 ln 2), 2 / (5 ln 2)
  sum = hn::Add(hn::Mul(sum, tt), All(0.9617966939f));
  sum = hn::Add(hn::Mul(sum, tt), All(2.8853900818f));
  return hn::Add(hn::ConvertTo(df, e), hn::Mul(sum, t));
}

/// 2^x, limited to the range of normal floats.
HWY_INLINE VF Exp2(VF x) {
  const DF df;
  const DI di;
  x = hn::Min(hn::Max(x, All(-126)), All(127));
  const VI whole = hn::NearestInt(x);
  const VF f = hn::Sub(x, hn::ConvertTo(df, whole));  // -1/2 to 1/2
  VF sum = All(0.0001540353f);                        // ln(2)^k / k!
  for (const float c : {0.0013333558f, 0.0096181291f, 0.0555041087f, 0.2402265070f, 0.6931471806f, 1.0f})
    sum = hn::Add(hn::Mul(sum, f), All(c));
  return hn::Mul(sum, hn::BitCast(df, hn::ShiftLeft<23>(hn::Add(whole, hn::Set(di, 127)))));
}

/// x^y for x of at least 0; 0^0 is 1.
HWY_INLINE VF Power(VF x, VF y) {
  const DF df;
  const auto tiny = hn::Lt(x, All(1e-30f));
  const VF power = Exp2(hn::Mul(y, Log2(hn::IfThenElse(tiny, All(1), x))));
  return hn::IfThenElse(hn::Eq(y, hn::Zero(df)), All(1), hn::IfThenElse(tiny, hn::Zero(df), power));
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
