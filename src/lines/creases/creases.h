// SPDX-License-Identifier: Apache-2.0
// Creases told from the edges of a tessellation.
#pragma once

#include <vector>

#include "lines/creases/fold.h"

namespace frontmost::lines_detail {

/// Leaves out of `edges` the creases that are none by the surfaces on both sides. As edges are found in pictures
/// (J. Canny. A Computational Approach to Edge Detection. 1986): a strong fold is a crease, and so are weak ones on
/// which it goes on; of a triangle with three creases the faintest is none; and what ends in the air after one or two
/// edges is none, unless it is long. Silhouettes take part, so that what is found hardly depends on the view;
/// boundaries and borders hold what ends at them. The other edges, and their order, stay. O(edges).
void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution);

}  // namespace frontmost::lines_detail
