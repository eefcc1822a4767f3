// SPDX-License-Identifier: Apache-2.0
// The sums of the rows are made side by side. Each is added up column by column, as it would be alone, so that every
// instruction set gives the same bits; that is why the map lies by columns.

#include "shade/shadow/shadow_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/shadow/shadow_filter_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

float FilterShadow(const ShadowWindow& window) {
  const hn::CappedTag<float, shadow_taps> d;
  constexpr std::size_t taps = shadow_taps;
  const auto key = hn::Set(d, window.key);
  HWY_ALIGN float lit[taps];
  for (std::size_t j = 0; j < taps; j += hn::Lanes(d)) {
    auto sum = hn::Zero(d);
    for (std::size_t i = 0; i < taps; ++i) {
      const auto is_lit = hn::Le(hn::LoadU(d, window.keys + i * window.stride + j), key);
      sum = hn::Add(sum, hn::IfThenElseZero(is_lit, hn::Set(d, window.across[i])));
    }
    hn::Store(sum, d, lit + j);
  }
  float sum = 0;
  for (std::size_t j = 0; j < taps; ++j) sum += lit[j] * window.down[j];
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FilterShadow);

ShadowFilter shadow_filter(Isa isa) { return kernel_for(FilterShadowKernels, isa); }

}  // namespace frontmost::shading
#endif  // HWY_ONCE
