// SPDX-License-Identifier: Apache-2.0
// The lists of one job as data.
#pragma once

#include "abuffer/gather_kernel.h"
#include "abuffer/options.h"

namespace frontmost::abuffer_detail {

struct JobLists {
  std::vector<std::uint32_t> begin;  ///< by pixel of the rectangle, row by row; and the end of the last
  std::vector<Fragment> fragments;
  std::vector<std::uint32_t> numbers;  ///< of each fragment in Arrived
};

/// Leaves out what lies wholly behind opaque fragments that cover the whole pixel. Precondition: not flat.
[[nodiscard]] JobLists list_fragments(const FrameInput& frame, const TileJob& job, TileScratch& scratch,
                                      const Opacities& opacities);

}  // namespace frontmost::abuffer_detail
