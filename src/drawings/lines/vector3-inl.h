// SPDX-License-Identifier: Apache-2.0
// Vectors of three coordinates, each of which is a vector of lanes. The kernels of this room compute differences and
// products of such vectors, and normals with bounds on rounding errors.

// This file is included once for every target.
#if defined(FRONTMOST_LINES_VECTOR3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_LINES_VECTOR3_INL_H_
#undef FRONTMOST_LINES_VECTOR3_INL_H_
#else
#define FRONTMOST_LINES_VECTOR3_INL_H_
#endif

#include <glm/glm.hpp>

#include "base/exact_vector.h"
#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::lines_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Lanes3 {
  V x, y, z;
};

template <class D>
HWY_INLINE Lanes3<hn::Vec<D>> Splat(D d, const glm::vec<3, hn::TFromD<D>>& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
template <class V>
HWY_INLINE Lanes3<V> Minus(const Lanes3<V>& a, const Lanes3<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Lanes3<V> Abs(const Lanes3<V>& v) {
  return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)};
}
/// Sums in the order of glm::dot().
template <class V>
HWY_INLINE V Dot(const Lanes3<V>& a, const Lanes3<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

/// BoundedNormal of base/exact_vector.h for vectors of lanes: the same operations in the same order, in doubles.
template <class V>
struct BoundedNormals {
  Lanes3<V> value, error;

  HWY_INLINE BoundedNormals(const Lanes3<V>& a, const Lanes3<V>& b) {
    const auto minor = [](V p, V q, V r, V s) HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
    value = {minor(a.y, b.z, b.y, a.z), minor(a.z, b.x, b.z, a.x), minor(a.x, b.y, b.x, a.y)};
    const Lanes3<V> p = Abs(a), q = Abs(b);
    const V rounding = hn::Set(hn::DFromV<V>(), kRounding);
    const auto bound = [&](V s, V t, V u, V v)
                           HWY_ATTR { return hn::Mul(rounding, hn::Add(hn::Mul(s, t), hn::Mul(u, v))); };
    error = {bound(p.y, q.z, p.z, q.y), bound(p.z, q.x, p.x, q.z), bound(p.x, q.y, p.y, q.x)};
  }
  /// A bound on the rounding error of n.v, like bounded_dot().
  HWY_INLINE V ErrorOfDot(const Lanes3<V>& v) const {
    const Lanes3<V> a = Abs(v);
    return hn::Add(Dot(error, a), hn::Mul(hn::Set(hn::DFromV<V>(), kRounding), Dot(Abs(value), a)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
