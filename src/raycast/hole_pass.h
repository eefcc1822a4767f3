// SPDX-License-Identifier: Apache-2.0
// Rays that went into a hole go on.
#pragma once

#include "frontmost/visible.h"
#include "raycast/index/ray_tree.h"

namespace frontmost::raycast_detail {

/// Of a Visible that takes triangles with holes for whole: replaces what has a hole at its sample by what the ray meets
/// next. O(samples), and O(log n) and more for each ray that goes on.
void pass_holes(const RayTree& tree, Visible& visible, const Execution& execution);

}  // namespace frontmost::raycast_detail
