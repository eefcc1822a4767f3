// SPDX-License-Identifier: Apache-2.0
// Results of occlusion culling for the compared view. Culling decides about objects, not about pixels.
#pragma once

#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <cstdint>
#include <vector>

namespace frontmost::cli {

struct CullingRun {
  double prepare = 0;                               ///< milliseconds, once
  std::vector<double> times;                        ///< milliseconds per view
  std::uint64_t outside = 0, hidden = 0, open = 0;  ///< numbers of instances by verdict; `open` ones may be visible
  std::uint64_t seen = 0;                           ///< number of instances that the z-buffer shows at a sample
  std::uint64_t wrong = 0;  ///< number of visible instances that culling called outside or hidden; must be 0

  [[nodiscard]] std::uint64_t objects() const { return outside + hidden + open; }
};

/// Culls the view of `reference`, the z-buffer's answer, `runs` times. \throws Error as Occlusion::cull() does.
[[nodiscard]] CullingRun run_culling(const Surfaces& surfaces, const Visible& reference, int runs,
                                     const Execution& execution);

}  // namespace frontmost::cli
