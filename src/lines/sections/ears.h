// SPDX-License-Identifier: Apache-2.0
// Polygons with holes, cut into triangles between their corners.
#pragma once

#include <array>
#include <vector>

#include "lines/sections/regions.h"

namespace frontmost::lines_detail {

using FlatTriangle = std::array<glm::vec2, 3>;

/// Appends triangles that fill the region, counter-clockwise, each side with the corners of another or of an outline;
/// where corners lie on one line also some without area. All signs are exact. What crosses itself is filled somehow, by
/// triangles that may overlap. O(n log n) for what looks like a part, at worst O(n^2).
void fill(const Region& region, std::vector<FlatTriangle>& triangles, const Execution& execution);

}  // namespace frontmost::lines_detail
