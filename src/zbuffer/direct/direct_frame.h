// SPDX-License-Identifier: Apache-2.0
// One picture of a scene, straight from its own arrays.
#pragma once

#include "frontmost/visible.h"
#include "surfaces/placed_scene.h"

namespace frontmost::zbuffer_detail {

/// What ZBuffer::draw() gives of the clusters, to the bit. O(triangles + covered samples). Memory beside the result:
/// some 30 MiB, and 100 bytes for each large or clipped triangle of half a million in a row.
[[nodiscard]] Visible draw_directly(const PlacedScene& scene, const View& view, const Execution& execution);

}  // namespace frontmost::zbuffer_detail
