// SPDX-License-Identifier: Apache-2.0
// Colours of one tile's fragments, laid over each other in the order of depth.
#pragma once

#include "abuffer/gather/gather_kernel.h"

namespace frontmost::abuffer_detail {

/// Linear colours with straight alpha, 0 to 1.
struct FragmentColors {
  const glm::vec4* table;
  bool by_fragment;  ///< numbered as in Arrived; otherwise by primitive. Never of flat frames.
  float opacity;     ///< multiplies every alpha
};

/// Planes of the whole picture, or of a part of it.
struct PicturePlanes {
  float *red, *green, *blue, *alpha;
  int width;
  int x = 0, y = 0;      ///< of the picture's pixel that comes first
  bool streams = false;  ///< write them past the cache: they are too large to stay in it
};

/// Writes a job's pixels: premultiplied means over the sub-samples. At every sub-sample the order is that of the keys
/// there, the lower id first where they are equal.
void composite_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch,
                    const FragmentColors& colors, const PicturePlanes& out);

}  // namespace frontmost::abuffer_detail
