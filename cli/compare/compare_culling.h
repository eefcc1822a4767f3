// SPDX-License-Identifier: Apache-2.0
// What occlusion culling proves of the same view, beside the methods: it answers for objects, not for pixels.
#pragma once

#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <cstdint>
#include <vector>

namespace frontmost::cli {

struct CullingRun {
  double prepare = 0;                               ///< milliseconds, once
  std::vector<double> times;                        ///< of the view, milliseconds
  std::uint64_t outside = 0, hidden = 0, open = 0;  ///< instances by what is known of them; open: they may be seen
  std::uint64_t seen = 0;                           ///< instances that the z-buffer shows at a sample
  std::uint64_t wrong = 0;                          ///< those among them that were said to be outside or hidden: none

  [[nodiscard]] std::uint64_t objects() const { return outside + hidden + open; }
};

/// Culls the view of `reference`, what the z-buffer found, so many times. \throws Error as Occlusion::cull() does.
[[nodiscard]] CullingRun run_culling(const Surfaces& surfaces, const Visible& reference, int runs,
                                     const Execution& execution);

}  // namespace frontmost::cli
