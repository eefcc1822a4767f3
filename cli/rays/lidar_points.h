// SPDX-License-Identifier: Apache-2.0
// A scan as a file of points.
#pragma once

#include <string>

#include "cli/view/ray_scene.h"

namespace frontmost::cli {

/// A binary PLY with a vertex for every ray that meets something, by rings and then by steps: x, y, z and range
/// (floats, in the model's own coordinates; where they lie far from zero x, y and z are doubles), object, triangle
/// (within its object; of a curved one its sphere or patch), ring and step (32 bits).
[[nodiscard]] std::string points_ply(const RangeScan& scan, const RayScene& rays);

}  // namespace frontmost::cli
