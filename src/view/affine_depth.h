// SPDX-License-Identifier: Apache-2.0
// Depths of corners, so that what lies between them on the screen has the mean of them.
#pragma once

#include "frontmost/view.h"

namespace frontmost {

/// Perspective: depths are not affine over the screen, their reciprocals are. Its own inverse.
[[nodiscard]] inline double affine_depth(const View& view, double depth) {
  return view.projection.orthographic ? depth : 1 / depth;
}

}  // namespace frontmost
