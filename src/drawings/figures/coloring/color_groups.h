// SPDX-License-Identifier: Apache-2.0
// Groups of nearly equal colours.
//
// Pieces of a polygon with an invisible difference get one colour, so that they can be one shape of the file. A colour
// joins the first group whose first colour is near enough, so groups never drift.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

namespace frontmost::shading {

/// The greatest difference of any channel.
[[nodiscard]] float difference(const glm::vec4& a, const glm::vec4& b);

/// Groups are numbered in the order in which they were added. A photograph has as many colours as pieces, so groups are
/// found by cells of a grid over all colours.
class ColorGroups {
 public:
  /// Channels, 0 to 255, may differ by `reach`.
  explicit ColorGroups(double reach);

  /// The number of the first group within reach of `color`; adds a new group if there is none.
  std::uint32_t find_or_add(const glm::vec4& color);
  [[nodiscard]] const std::vector<glm::vec4>& colors() const { return colors_; }

 private:
  [[nodiscard]] std::uint32_t find(const glm::ivec4& cell, const glm::vec4& color) const;

  const double reach_, cell_size_;
  std::vector<glm::vec4> colors_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace frontmost::shading
