// SPDX-License-Identifier: Apache-2.0
// Triangles that are there again.
#pragma once

#include "raycast/index/ray_tree.h"

namespace frontmost {

/// Where thousands of triangles are those before them once more, as of objects that are placed a million times in one
/// place, moves them to a tree of their own, whose leaves alone are filled. Leaves of `tree` are in the surfaces'
/// spatial order, in which copies follow each other. \returns null, and leaves all as it is, where there are few.
[[nodiscard]] std::shared_ptr<RayTree> take_copies(RayTree& tree, const Execution& execution);

}  // namespace frontmost
