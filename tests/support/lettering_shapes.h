// SPDX-License-Identifier: Apache-2.0
// Finds texts among the strokes of a drawing.
#pragma once

#include <string>
#include <vector>

#include "frontmost/sheets.h"

namespace frontmost::test {

/// Number of occurrences in `points` of the consecutive points of `text`, in letters of `height`, at any place.
inline int count_texts(const std::vector<glm::dvec2>& points, const std::string& text, double height) {
  PageGroup letters;
  add_text(letters, text, {0, 0}, {height});
  const std::vector<glm::dvec2>& wanted = letters.points;
  int count = 0;
  for (std::size_t first = 0; first + wanted.size() <= points.size(); ++first) {
    std::size_t i = 0;
    const glm::dvec2 by = points[first] - wanted[0];
    while (i < wanted.size() && glm::distance(points[first + i], wanted[i] + by) < 0.0025) ++i;  // rounded twice
    count += i == wanted.size();
  }
  return count;
}
inline bool holds_text(const std::vector<glm::dvec2>& points, const std::string& text, double height) {
  return count_texts(points, text, height) > 0;
}

}  // namespace frontmost::test
