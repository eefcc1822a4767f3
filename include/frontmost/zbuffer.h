// SPDX-License-Identifier: Apache-2.0
// The z-buffer: visibility by rasterisation into tiles.
#pragma once

#include "frontmost/surfaces.h"
#include "frontmost/view.h"
#include "frontmost/visible.h"

namespace frontmost {

/// The front-most triangle at every sample. Vertices are snapped to 1/256 pixel, coverage is exact by the top-left
/// rule, depth keys are interpolated in screen space, where they are affine; at equal keys the lower id wins.
/// The result is the same to the bit for any number of threads and any instruction set.
/// O(triangles + covered samples) time; 8 bytes a sample for the result.
/// \throws Error as validate(view) does.
[[nodiscard]] Visible zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution = {});

}  // namespace frontmost
