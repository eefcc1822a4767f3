// SPDX-License-Identifier: Apache-2.0
#include "base/lanes_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "base/lanes_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This include comes after Highway, in a block of its own.
#include "base/compactor-inl.h"
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::HWY_NAMESPACE {
namespace {

void Pack(std::uint32_t set, const float* values, test::PackedVector& packed) {
  static_assert(kMaxLanes <= test::most_lanes);
  const DF d;
  packed.lanes = hn::Lanes(d);
  // Highway reads eight bytes, whatever the number of lanes.
  alignas(8) const std::uint8_t bytes[8] = {std::uint8_t(set), std::uint8_t(set >> 8)};
  const MF mask = hn::LoadMaskBits(d, bytes);
  packed.bits = BitsOf(d, mask);
  const Compactor<DF> compact(mask);
  packed.count = compact.count();
  compact.Store(hn::LoadU(d, values), packed.floats.data());
  compact.Store(hn::BitCast(DU(), CountFrom(DI(), 100)), packed.numbers.data());
  packed.count_into = CompactInto(hn::LoadU(d, values), mask, d, packed.into.data());
  ForEachBit(packed.bits, [&](std::size_t lane) { packed.visited.push_back(lane); });
}

void Count(std::int32_t first, std::vector<std::int32_t>& out) {
  const DI d;
  out.resize(hn::Lanes(d));
  hn::StoreU(CountFrom(d, first), d, out.data());
}

}  // namespace
}  // namespace frontmost::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost {

FRONTMOST_KERNELS(Pack);
FRONTMOST_KERNELS(Count);

test::PackedVector test::pack(std::uint32_t set, const std::array<float, most_lanes>& values, float rest, Isa isa) {
  PackedVector packed;
  packed.floats.fill(rest);
  packed.into.fill(rest);
  kernel_for(PackKernels, isa)(set, values.data(), packed);
  return packed;
}

std::vector<std::int32_t> test::count_from(std::int32_t first, Isa isa) {
  std::vector<std::int32_t> out;
  kernel_for(CountKernels, isa)(first, out);
  return out;
}

}  // namespace frontmost
#endif  // HWY_ONCE
