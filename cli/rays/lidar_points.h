// SPDX-License-Identifier: Apache-2.0
// A scan as a file of points.
#pragma once

#include <frontmost/ray_camera.h>

#include <string>

namespace frontmost::cli {

/// A binary PLY with a vertex for every ray that meets something, by rings and then by steps: x, y, z and range
/// (floats, in the model's own coordinates), object, triangle (within its object), ring and step (32 bits).
[[nodiscard]] std::string points_ply(const RangeScan& scan, const Surfaces& surfaces);

}  // namespace frontmost::cli
