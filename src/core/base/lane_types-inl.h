// SPDX-License-Identifier: Apache-2.0
// Names for whole vectors of 32-bit numbers, for kernels that use as many lanes as the machine has.
//
//   D  a tag: which numbers, and how many of them     F  float
//   V  a vector of such numbers                       I  signed 32-bit integer
//   M  a mask: yes or no for each of them             U  unsigned 32-bit integer
//
// Kernels with a fixed number of lanes (raycast's rays, hidden lines' occluders) name types of their own instead.

// Included once for every target.
#if defined(FRONTMOST_BASE_LANE_TYPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_BASE_LANE_TYPES_INL_H_
#undef FRONTMOST_BASE_LANE_TYPES_INL_H_
#else
#define FRONTMOST_BASE_LANE_TYPES_INL_H_
#endif

#include <cstddef>

#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using MF = hn::Mask<DF>;
using MI = hn::Mask<DI>;

/// The greatest number of lanes, as a compile-time constant: for arrays that hold a vector.
constexpr std::size_t kMaxLanes = hn::MaxLanes(DF());

/// A vector with `value` in every lane.
HWY_INLINE VF All(float value) { return hn::Set(DF(), value); }

}  // namespace frontmost::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
