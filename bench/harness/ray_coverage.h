// SPDX-License-Identifier: Apache-2.0
// Our picture and that of rays through the pixel centres, which snap nothing: how many pixels differ, and why.
#pragma once

#include "peers/peer.h"

namespace frontmost::bench {

struct RayReport {
  std::size_t covered = 0;                   ///< pixels covered by both
  std::size_t only_ours = 0, only_rays = 0;  ///< pixels
  std::size_t other_ids = 0;                 ///< covered by both, by another triangle

  // The reasons, one for each pixel that differs.
  std::size_t edge = 0;       ///< an edge of one of the two triangles passes within 1/128 pixel of the pixel's centre
  std::size_t clipped = 0;    ///< one of the triangles crosses the near plane or leaves the guard band: not looked into
  std::size_t depth = 0;      ///< the depths differ by less than 1e-5 of the distance
  std::size_t disagreed = 0;  ///< none of these

  [[nodiscard]] std::size_t differing() const { return only_ours + only_rays + other_ids; }
};

/// Precondition: `scene` is one mesh in one instance without a transform, `visible` has one sample a pixel, and the
/// peer's depths are planar distances.
[[nodiscard]] RayReport compare_with_rays(const Scene& scene, const Visible& visible, RayPeer& peer);

}  // namespace frontmost::bench
