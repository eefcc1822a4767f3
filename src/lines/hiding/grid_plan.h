// SPDX-License-Identifier: Apache-2.0
// What an occluder grid is made of: known while it is made, and not after.
#pragma once

#include "base/parallel.h"
#include "lines/hiding/occluder_grid.h"

namespace frontmost::lines_detail {

constexpr std::size_t kPerPart = 4096;

/// Asks now and then whether to stop, where a part of the work is all that a thread has to do.
inline void poll(const Execution& execution, std::size_t i) {
  if (i % 16384 == 0) check_cancelled(execution);
}

struct OccluderGrid::Plan {
  OnGrid on_grid;
  const Execution& execution;
  const bool keeps_all;
  Buffer<Footprint> footprints;
  Buffer<Extent> extents;            ///< of the footprints
  std::vector<std::uint32_t> large;  ///< of the footprints

  [[nodiscard]] const Sight& sight() const { return on_grid.sight; }
  [[nodiscard]] const WeldedMesh& mesh() const { return on_grid.seen.mesh; }
};

}  // namespace frontmost::lines_detail
