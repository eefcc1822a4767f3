// SPDX-License-Identifier: Apache-2.0
// Chooses a kernel by Execution::isa. Include after base/highway-inl.h.
//
// A *_kernel.cpp is compiled once for each instruction set, by base/highway-inl.h, and leaves a table of functions:
//
//   Kernels[]  = { ..., AVX-512, AVX2, ..., SSE4, ..., none }   one entry for each of Highway's targets, the best first
//   kernel_for(Kernels, isa)  ->  the entry of the highest target that `isa` allows
//
// Highway's own dispatch chooses once for the whole process. Here every call chooses by its Execution, so tests can
// compare instruction sets, and nothing global is written.
#pragma once

#include <cstdint>

#include "frontmost/base.h"
#include "hwy/base.h"
#include "hwy/targets.h"

namespace frontmost {

/// Highway's target bits that may run for `isa`. \throws Error unsupported if this machine or build lacks it.
[[nodiscard]] std::int64_t highway_targets(Isa isa);

/// Defines `functionKernels`: the kernels that base/highway-inl.h made of `function`, in Highway's order. HWY_EXPORT's
/// table has one more entry, which needs Highway's library; loading it would cost every start of a program 2 ms.
#define FRONTMOST_KERNELS(function)                                                                                  \
  static constexpr decltype(&HWY_STATIC_DISPATCH(function)) function##Kernels[] = {HWY_CHOOSE_TARGET_LIST(function), \
                                                                                   HWY_CHOOSE_FALLBACK(function)}

/// The entry of a FRONTMOST_KERNELS table for `isa`. Reads no global choice, so two threads may run different
/// instruction sets.
template <class Function, std::size_t size>
[[nodiscard]] Function kernel_for(Function const (&table)[size], Isa isa) {
  static_assert(size == HWY_MAX_DYNAMIC_TARGETS + 1);
  const std::int64_t wanted = HWY_CHOSEN_TARGET_SHIFT(highway_targets(isa)) | HWY_CHOSEN_TARGET_MASK_SCALAR;
  const auto compiled = static_cast<std::uint64_t>(wanted & HWY_CHOSEN_TARGET_MASK_TARGETS);
  return table[hwy::Num0BitsBelowLS1Bit_Nonzero64(compiled) - 1];  // bit 0 stands for an entry of Highway's own
}

}  // namespace frontmost
