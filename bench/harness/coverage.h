// SPDX-License-Identifier: Apache-2.0
// Our picture against llvmpipe's and against one by rays: how many pixels differ, and why each does.
//
// llvmpipe transforms in 32-bit floats by another matrix, so a vertex may lie 1/256 pixel away from ours. A moved
// vertex moves edges, and moved edges cover other pixels. The comparison computes both positions of every vertex and
// applies the exact rule to each differing pixel twice: with our positions and with llvmpipe's.
//
// Rays through the pixel centres snap nothing, so they see another triangle where an edge passes close to a centre.
#pragma once

#include "peers/peer.h"

namespace frontmost::bench {

/// Comparison with llvmpipe.
struct CoverageReport {
  std::size_t vertices = 0, moved_vertices = 0;  ///< moved: llvmpipe snaps them to another place
  std::size_t covered = 0;                       ///< pixels covered by both
  std::size_t only_ours = 0, only_theirs = 0;    ///< pixels
  std::size_t other_ids = 0;                     ///< pixels covered by both, but with another triangle in front

  // The reasons, one for each pixel that differs.
  std::size_t moved = 0;    ///< a vertex lies elsewhere, and the exact rule gives their answer with their position
  std::size_t clipped = 0;  ///< one program clipped the triangle at the view volume, which makes new vertices
  /// Both triangles cover the pixel in both pictures, and each picture shows the nearer one by its own depths. llvmpipe
  /// interpolates between vertices that are not snapped, and rounds differently.
  std::size_t depth = 0;
  std::size_t disagreed = 0;  ///< none of these: the coverage rules differ, or a depth is plainly wrong

  [[nodiscard]] std::size_t differing() const { return only_ours + only_theirs + other_ids; }
};

/// Precondition: `scene` is one mesh in one instance without a transform, and `visible` has one sample a pixel.
[[nodiscard]] CoverageReport compare_coverage(const Scene& scene, const Visible& visible, RasterPeer& peer);

/// Comparison with rays.
struct RayReport {
  std::size_t covered = 0;                   ///< pixels covered by both
  std::size_t only_ours = 0, only_rays = 0;  ///< pixels
  std::size_t other_ids = 0;                 ///< pixels covered by both, but with another triangle

  // The reasons, one for each pixel that differs.
  std::size_t edge = 0;       ///< an edge of one of the two triangles passes within 1/128 pixel of the pixel's centre
  std::size_t clipped = 0;    ///< one of the triangles crosses the near plane or leaves the guard band; not examined
  std::size_t depth = 0;      ///< the depths differ by less than 1e-5 of the distance
  std::size_t disagreed = 0;  ///< none of these

  [[nodiscard]] std::size_t differing() const { return only_ours + only_rays + other_ids; }
};

/// Precondition: `scene` is one mesh in one instance without a transform, `visible` has one sample a pixel, and the
/// peer's depths are planar distances.
[[nodiscard]] RayReport compare_with_rays(const Scene& scene, const Visible& visible, RayPeer& peer);

}  // namespace frontmost::bench
