// SPDX-License-Identifier: Apache-2.0
// The segments in which triangles meet a plane, put together to closed lines.
#pragma once

#include <vector>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

/// With what is cut on its left, where its triangle is wound outwards.
struct CutSegment {
  glm::vec2 from, to;
};

/// The last point is joined to the first. No point is there twice.
using SectionOutline = std::vector<glm::vec2>;

struct Outlines {
  std::vector<SectionOutline> closed;
  std::size_t open_count = 0;
  bool is_wound_alike = true;  ///< no segment had to be turned round
};

/// Where lines touch, those to the left are taken first, so that they do not cross. Segments that are there in both
/// directions cancel each other. O(n log n).
[[nodiscard]] Outlines find_outlines(const std::vector<CutSegment>& segments, const Execution& execution);

}  // namespace frontmost::lines_detail
