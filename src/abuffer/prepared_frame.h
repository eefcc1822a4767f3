// SPDX-License-Identifier: Apache-2.0
// A view looked into before its tiles are gathered.
#pragma once

#include "abuffer/gather/gather_kernel.h"
#include "abuffer/options.h"

namespace frontmost::abuffer_detail {

struct PreparedFrame {
  SamplePattern pattern;
  FragmentPlan plan;

  /// \throws Error for a view or options out of range.
  PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution)
      : pattern((frontmost::validate(view), validate(options), sample_pattern(view, options.grid))),
        plan(surfaces, view, execution) {}

  /// Of lists that say all. As long as this, and the rule, are where they are.
  [[nodiscard]] GatherInput input(const CopyRule& copies, const Execution& execution) const {
    return {plan, pattern, false, execution.isa, copies};
  }
};

}  // namespace frontmost::abuffer_detail
