// SPDX-License-Identifier: Apache-2.0
// The title block by itself.
#pragma once

#include <vector>

#include "frontmost/title_block.h"

namespace frontmost::detail {

inline constexpr glm::dvec2 title_block_size{180, 36};

/// Appends the groups of a title block whose upper left corner is `corner`.
void draw_title_block(const TitleBlock& block, const glm::dvec2& corner, PageLayer& layer);

[[nodiscard]] inline std::vector<glm::dvec2> rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

}  // namespace frontmost::detail
