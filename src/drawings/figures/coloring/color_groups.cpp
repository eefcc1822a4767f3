// SPDX-License-Identifier: Apache-2.0
// Cells are slightly wider than the reach, so a near enough colour is in the same cell or in a neighbour: 81 cells of
// four channels. That costs more than testing a few colours, so cells are used only from 64 colours on. Both ways find
// the first colour that is near enough, so the result depends only on the order of colours.
#include "figures/coloring/color_groups.h"

#include <algorithm>
#include <cmath>

#include "frontmost/base.h"

namespace frontmost::shading {
namespace {

/// Up to so many colours are tested one by one.
constexpr std::size_t kFewColors = 64;
/// Least size of a cell, in steps of 8 bits.
constexpr double kLeastCell = 1.0 / 64;

std::uint64_t key_of(const glm::ivec4& cell) {
  std::uint64_t key = 0;
  for (int k = 0; k < 4; ++k) key = key << 16 | std::uint16_t(cell[k]);
  return key;
}

}  // namespace

float difference(const glm::vec4& a, const glm::vec4& b) {
  const glm::vec4 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z, d.w});
}

ColorGroups::ColorGroups(double reach) : reach_(reach), cell_size_(std::max(reach * 1.001, kLeastCell)) {}

std::uint32_t ColorGroups::find(const glm::ivec4& cell, const glm::vec4& color) const {
  if (colors_.size() <= kFewColors) {
    const auto same = std::find_if(colors_.begin(), colors_.end(),
                                   [&](const glm::vec4& c) { return double(difference(c, color)) <= reach_; });
    return same == colors_.end() ? no_index : std::uint32_t(same - colors_.begin());
  }
  std::uint32_t first = no_index;
  for (int i = 0; i < 81; ++i) {
    const glm::ivec4 beside(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 - 1);
    const auto found = cells_.find(key_of(cell + beside));
    if (found == cells_.end()) continue;
    for (const std::uint32_t number : found->second)
      if (number < first && double(difference(colors_[number], color)) <= reach_) first = number;
  }
  return first;
}

std::uint32_t ColorGroups::find_or_add(const glm::vec4& color) {
  const glm::ivec4 cell(glm::floor(glm::dvec4(color) / cell_size_));
  const std::uint32_t same = find(cell, color);
  if (same != no_index) return same;
  const auto number = std::uint32_t(colors_.size());
  colors_.push_back(color);
  cells_[key_of(cell)].push_back(number);
  return number;
}

}  // namespace frontmost::shading
