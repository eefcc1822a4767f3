// SPDX-License-Identifier: Apache-2.0
// Our picture beside llvmpipe's, and beside that of rays, pixel by pixel: how many differ, and why each does.
//
// llvmpipe transforms in 32-bit floats by another matrix, so a vertex may come to lie 1/256 pixel elsewhere than ours.
// That moves edges, and moved edges cover other pixels. Here both places of every vertex are computed, and each pixel
// that differs is put to the exact rule twice: with our places and with theirs.
//
// Rays through the pixel centres snap nothing, so they see another triangle where an edge passes a centre closely.
#pragma once

#include "peers/peer.h"

namespace frontmost::bench {

/// Beside llvmpipe.
struct CoverageReport {
  std::size_t vertices = 0, moved_vertices = 0;  ///< moved: snapped to another place by llvmpipe
  std::size_t covered = 0;                       ///< pixels covered by both
  std::size_t only_ours = 0, only_theirs = 0;    ///< pixels
  std::size_t other_ids = 0;                     ///< pixels covered by both, but with another triangle in front

  // The reasons, one for each pixel that differs.
  std::size_t moved = 0;    ///< a vertex lies elsewhere, and with its place the exact rule gives their answer
  std::size_t clipped = 0;  ///< one of us cut the triangle at the edge of the view volume, which makes new vertices
  /// Both triangles cover the pixel in both pictures, and each picture shows what is nearer by its own depths: theirs
  /// are interpolated between vertices that are not snapped, and rounded otherwise.
  std::size_t depth = 0;
  std::size_t disagreed = 0;  ///< none of these: the coverage rules themselves differ, or a depth is plainly wrong

  [[nodiscard]] std::size_t differing() const { return only_ours + only_theirs + other_ids; }
};

/// Precondition: `scene` is one mesh in one instance without a transform, and `visible` has one sample a pixel.
[[nodiscard]] CoverageReport compare_coverage(const Scene& scene, const Visible& visible, RasterPeer& peer);

/// Beside rays.
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
