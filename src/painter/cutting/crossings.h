// SPDX-License-Identifier: Apache-2.0
// How many cuts are taken by triangles that pass through each other.
#pragma once

#include <vector>

#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// The least number of cuts that a list of whole triangles and pieces takes, for those of them that pass through each
/// other; as far as a few hundred pairs tell: it may be too great once in ten thousand times.
[[nodiscard]] double least_cuts(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll);

}  // namespace frontmost::painter_detail
