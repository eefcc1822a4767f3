// SPDX-License-Identifier: Apache-2.0
// Pieces in the order of painting, as far as they have one.
#pragma once

#include "frontmost/painter.h"
#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// Pieces one after another, in groups: a group of one can be painted whole, those of more have to be cut. Every group
/// covers only those before it.
struct Groups {
  std::vector<std::uint32_t> pieces;
  std::vector<std::size_t> ends;
};

/// Reports progress where `is_all`: these are all the pieces that there are.
[[nodiscard]] Groups depth_sort(const Pieces& pieces, const std::vector<std::uint32_t>& members, bool is_all,
                                PaintSteps& steps, Poll& poll);

/// By farthest points, the farthest first, then by id.
void sort_by_farthest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution);

}  // namespace frontmost::painter_detail
