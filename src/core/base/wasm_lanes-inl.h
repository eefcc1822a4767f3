// SPDX-License-Identifier: Apache-2.0
// Operations that Highway 1.0.3 lacks on WebAssembly: arithmetic of doubles, and masks and tables that do not go
// through memory. They reduce the time of a whole frame to a quarter.
//
// These are overloads in Highway's own namespace, so that kernels are written once for every target. The order of
// arguments of minimum and maximum is that of Highway's floats: of a NaN and a number the result is the second
// argument, as in SSE.

// Included once for every target.
#if defined(FRONTMOST_BASE_WASM_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_BASE_WASM_LANES_INL_H_
#undef FRONTMOST_BASE_WASM_LANES_INL_H_
#else
#define FRONTMOST_BASE_WASM_LANES_INL_H_
#endif

#include "base/highway-inl.h"

#if HWY_TARGET == HWY_WASM
HWY_BEFORE_NAMESPACE();
namespace hwy::HWY_NAMESPACE {

template <std::size_t N>
using Doubles = Vec128<double, N>;
template <std::size_t N>
using DoublesMask = Mask128<double, N>;

template <std::size_t N, HWY_IF_LE128(double, N)>
HWY_API Doubles<N> Set(Simd<double, N, 0>, const double t) {
  return {wasm_f64x2_splat(t)};
}

#define FRONTMOST_DOUBLES(type, name, instruction)               \
  template <std::size_t N>                                       \
  HWY_API type<N> name(const Doubles<N> a, const Doubles<N> b) { \
    return {instruction(a.raw, b.raw)};                          \
  }
FRONTMOST_DOUBLES(Doubles, operator+, wasm_f64x2_add)
FRONTMOST_DOUBLES(Doubles, operator-, wasm_f64x2_sub)
FRONTMOST_DOUBLES(Doubles, operator*, wasm_f64x2_mul)
FRONTMOST_DOUBLES(Doubles, operator/, wasm_f64x2_div)
FRONTMOST_DOUBLES(DoublesMask, operator==, wasm_f64x2_eq)
FRONTMOST_DOUBLES(DoublesMask, operator!=, wasm_f64x2_ne)
FRONTMOST_DOUBLES(DoublesMask, operator<, wasm_f64x2_lt)
FRONTMOST_DOUBLES(DoublesMask, operator<=, wasm_f64x2_le)
FRONTMOST_DOUBLES(DoublesMask, operator>, wasm_f64x2_gt)
FRONTMOST_DOUBLES(DoublesMask, operator>=, wasm_f64x2_ge)
#undef FRONTMOST_DOUBLES

template <std::size_t N>
HWY_API Doubles<N> Min(const Doubles<N> a, const Doubles<N> b) {
  return {wasm_f64x2_pmin(b.raw, a.raw)};
}
template <std::size_t N>
HWY_API Doubles<N> Max(const Doubles<N> a, const Doubles<N> b) {
  return {wasm_f64x2_pmax(b.raw, a.raw)};
}
template <std::size_t N>
HWY_API Doubles<N> Abs(const Doubles<N> v) {
  return {wasm_f64x2_abs(v.raw)};
}
template <std::size_t N>
HWY_API Doubles<N> Sqrt(const Doubles<N> v) {
  return {wasm_f64x2_sqrt(v.raw)};
}
template <std::size_t N>
HWY_API Doubles<N> Ceil(const Doubles<N> v) {
  return {wasm_f64x2_ceil(v.raw)};
}
template <std::size_t N>
HWY_API Doubles<N> Floor(const Doubles<N> v) {
  return {wasm_f64x2_floor(v.raw)};
}
template <std::size_t N>
HWY_API double GetLane(const Doubles<N> v) {
  return wasm_f64x2_extract_lane(v.raw, 0);
}

template <std::size_t N, HWY_IF_LE128(double, N)>
HWY_API Doubles<N> PromoteTo(Simd<double, N, 0>, const Vec128<float, N> v) {
  return {wasm_f64x2_promote_low_f32x4(v.raw)};
}
template <std::size_t N, HWY_IF_LE128(float, N)>
HWY_API Vec128<float, N> DemoteTo(Simd<float, N, 0>, const Doubles<N> v) {
  return {wasm_f32x4_demote_f64x2_zero(v.raw)};
}

#define FRONTMOST_MASKS(T)                                                                                      \
  HWY_API bool AllFalse(Full128<T>, const Mask128<T> m) { return !wasm_v128_any_true(m.raw); }                  \
  HWY_API std::size_t CountTrue(Full128<T>, const Mask128<T> m) { return PopCount(wasm_i32x4_bitmask(m.raw)); } \
  HWY_API std::size_t StoreMaskBits(Full128<T>, const Mask128<T> m, std::uint8_t* bits) {                       \
    bits[0] = std::uint8_t(wasm_i32x4_bitmask(m.raw));                                                          \
    return 1;                                                                                                   \
  }                                                                                                             \
  HWY_API Vec128<T> TableLookupLanes(const Vec128<T> v, const Indices128<T> lanes) {                            \
    return BitCast(Full128<T>(), Vec128<std::uint8_t>{wasm_i8x16_swizzle(v.raw, lanes.raw)});                   \
  }                                                                                                             \
  HWY_API Indices128<T> IndicesFromVec(Full128<T>, const Vec128<std::int32_t> v) {                              \
    /* Four times the lane in each of its bytes, and the byte's own number. */                                  \
    return {wasm_i32x4_add(wasm_i32x4_mul(v.raw, wasm_i32x4_splat(0x04040404)), wasm_i32x4_splat(0x03020100))}; \
  }
FRONTMOST_MASKS(float)
FRONTMOST_MASKS(std::int32_t)
FRONTMOST_MASKS(std::uint32_t)
#undef FRONTMOST_MASKS

}  // namespace hwy::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard by target
