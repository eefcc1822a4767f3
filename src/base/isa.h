// SPDX-License-Identifier: Apache-2.0
// Choosing a kernel by Execution::isa from the table that HWY_EXPORT makes. Include after hwy/highway.h.
#pragma once

#include <cstdint>

#include "frontmost/base.h"
#include "hwy/targets.h"

namespace frontmost {

/// Highway's target bits that may run for `isa`. \throws Error unsupported when this machine or build lacks it.
[[nodiscard]] std::int64_t highway_targets(Isa isa);

/// The entry of `table` (HWY_DISPATCH_TABLE of an exported function) for `isa`. Reads no global choice, so that two
/// threads may run different instruction sets.
template <class Function, std::size_t size>
[[nodiscard]] Function kernel_for(Function const (&table)[size], Isa isa) {
  static_assert(size == HWY_MAX_DYNAMIC_TARGETS + 2);
  hwy::ChosenTarget target;
  target.Update(highway_targets(isa));
  return table[target.GetIndex()];
}

}  // namespace frontmost
