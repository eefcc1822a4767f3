// SPDX-License-Identifier: Apache-2.0
// Finding what is visible, by the default z-buffer, by rays, or by a depth buffer with the state that the user asked
// for.
#pragma once

#include <frontmost/depth_buffer.h>
#include <frontmost/raycast.h>

#include <optional>

#include "cli/settings.h"

namespace frontmost::cli {

struct SeenView {
  Visible visible;
  Buffer<float> window_depths;  ///< of a depth buffer, in the order of Visible; empty without one
};

/// The state with its defaults filled in, which --reversed changes.
[[nodiscard]] DepthState depth_state(const DepthSettings& settings);
[[nodiscard]] double depth_clear(const DepthSettings& settings);

/// By rays where there is an index.
[[nodiscard]] SeenView look_at_surfaces(const Surfaces& surfaces, const View& view, const DepthSettings& settings,
                                        const Execution& execution, const RayIndex* index = nullptr);

/// "D8", "LESS" and so on, as on the command line.
[[nodiscard]] std::string_view name(DepthFormat format);
[[nodiscard]] std::string_view name(DepthFunc func);

}  // namespace frontmost::cli
