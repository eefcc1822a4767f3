// SPDX-License-Identifier: Apache-2.0
// What scans of triangles and of curved surfaces have in common.
#pragma once

#include <functional>
#include <span>

#include "frontmost/ray_camera.h"

namespace frontmost::raycast_detail {

/// With room for the answers. \throws Error as validate(camera) does.
[[nodiscard]] RangeScan prepare_scan(const RayCamera& camera);

/// For some rays of the grid, of which the first has the number `first`.
using CastPart = std::function<void(std::size_t first, std::span<const Ray> rays)>;

/// Calls cast() for all parts of the camera's grid, on all threads, and tells how far it is.
void cast_parts(const RangeScan& scan, const Execution& execution, const CastPart& cast);

}  // namespace frontmost::raycast_detail
