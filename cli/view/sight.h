// SPDX-License-Identifier: Apache-2.0
// Determines visibility: in all pixels of a view, by the default z-buffer, by rays, or by a depth buffer with the
// user's state; and along single rays.
#pragma once

#include <frontmost/image.h>
#include <frontmost/raycast.h>
#include <frontmost/zbuffer.h>

#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

struct SeenView {
  Visible visible;
  Buffer<float> window_depths;  ///< stored depths of a depth buffer, in the order of `visible`; else empty
};

/// Returns the depth state with defaults, which depend on --reversed.
[[nodiscard]] DepthState depth_state(const DepthSettings& settings);
[[nodiscard]] double depth_clear(const DepthSettings& settings);

/// Determines visibility in all pixels of a view. Casts rays if there is an index.
[[nodiscard]] SeenView look_at_surfaces(const Surfaces& surfaces, const View& view, const DepthSettings& settings,
                                        const Execution& execution, const RayIndex* index = nullptr);

/// Returns names as on the command line: "D8", "LESS" and so on.
[[nodiscard]] std::string_view name(DepthFormat format);
[[nodiscard]] std::string_view name(DepthFunc func);

/// Borrows surfaces and their index.
struct RayScene {
  const Surfaces& surfaces;
  const RayIndex& index;

  [[nodiscard]] const Scene& scene() const { return surfaces.scene(); }
  [[nodiscard]] RangeScan scan(const RayCamera& camera, const Execution& execution) const {
    return frontmost::scan(index, camera, execution);
  }
  [[nodiscard]] std::vector<RayHit> closest(std::span<const Segment> segments, const Execution& execution) const;
  [[nodiscard]] Image ids(const RangeScan& scan, IdKind kind) const;
};

}  // namespace frontmost::cli
