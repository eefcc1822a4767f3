// SPDX-License-Identifier: Apache-2.0
// How many triangles pass through each other.
#pragma once

#include <vector>

#include "painter/pieces.h"
#include "painter/poll.h"

namespace frontmost::painter_detail {

/// The least number of pairs of a list of whole triangles and pieces that pass through each other, as far as a few
/// hundred pairs tell: it may be too great once in ten thousand times. 0 where some lie in one plane, or meet in
/// parallel lines, for these may be one.
[[nodiscard]] double least_crossings(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll);

}  // namespace frontmost::painter_detail
