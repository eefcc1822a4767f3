// SPDX-License-Identifier: Apache-2.0
// The lists of one job as data.
#pragma once

#include "abuffer/gather/gather_kernel.h"
#include "abuffer/options.h"

namespace frontmost::abuffer_detail {

struct JobLists {
  std::vector<std::uint32_t> begin;  ///< by pixel of the rectangle, row by row; and the end of the last
  std::vector<Fragment> fragments;
  std::vector<std::uint32_t> numbers;  ///< of each fragment in Arrived
  const GatherScratch* scratch = nullptr;

  /// The key of fragment i at a place in 1/256 pixel from the rectangle's corner, exactly as it is compared. Only as
  /// long as the scratch is as it was.
  [[nodiscard]] float key_at(std::size_t i, std::int32_t x, std::int32_t y) const {
    return scratch->triangles.key_at(scratch->arrived.triangle[numbers[i]], x, y);
  }
};

/// Leaves out what lies wholly behind opaque fragments that cover the whole pixel; and what lies wholly behind
/// fragments that cover it and together let no more pass than `negligible`. Precondition: not flat.
[[nodiscard]] JobLists list_fragments(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch,
                                      const Opacities& opacities, float negligible = 0);

}  // namespace frontmost::abuffer_detail
