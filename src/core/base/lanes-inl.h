// SPDX-License-Identifier: Apache-2.0
// Operations that Highway 1.0.3 lacks, or does through memory: masks as bits, and counting from a run-time number.
//
//   a mask of four lanes         set    -    set   set
//   its bits, lane 0 lowest      0b1101, of which ForEachBit() gives 0, 2 and 3

// Included once for every target.
#if defined(FRONTMOST_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_BASE_LANES_INL_H_
#undef FRONTMOST_BASE_LANES_INL_H_
#else
#define FRONTMOST_BASE_LANES_INL_H_
#endif

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// \returns a mask as bits: lane i is bit i. The bytes are read in the size in which they are stored, because a wider
/// read would wait until the store has reached the cache.
template <class D>
HWY_INLINE std::uint64_t BitsOf(D d, hn::Mask<D> mask) {
  using Bits = std::conditional_t<(hn::MaxLanes(D()) > 8), std::uint16_t, std::uint8_t>;
  static_assert(hn::MaxLanes(D()) <= 16);
  std::uint8_t bytes[8];
  hn::StoreMaskBits(d, mask, bytes);
  Bits bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((std::uint64_t(1) << hn::Lanes(d)) - 1);
}

/// \returns a vector of `first`, first + 1, first + 2 and so on. Highway's own function writes lanes to memory one by
/// one unless `first` is a compile-time constant.
template <class D>
HWY_INLINE hn::Vec<D> CountFrom(D d, hn::TFromD<D> first) {
  return hn::Add(hn::Iota(d, hn::TFromD<D>(0)), hn::Set(d, first));
}

/// Calls `body(i)` for every bit i, lowest first.
template <class Body>
HWY_INLINE void ForEachBit(std::uint64_t bits, Body&& body) {
  for (; bits != 0; bits &= bits - 1) body(std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits)));
}

}  // namespace frontmost::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
