// SPDX-License-Identifier: Apache-2.0
// Places of a pixel's sub-samples.
//
//    grid 0: the view's own samples        grid 2, 4, 8: that many rows and columns, in the middles of equal squares
//
// A pattern also knows how far its samples reach: triangles between the outermost samples of neighbouring pixels cover
// nothing, and their boxes show it.

#include <algorithm>
#include <string>

#include "abuffer/gather/gather_kernel.h"

namespace frontmost::abuffer_detail {
namespace {

void add(SamplePattern& pattern, std::int32_t x, std::int32_t y) {
  const auto i = std::size_t(pattern.count++);
  pattern.x[i] = x;
  pattern.y[i] = y;
}

}  // namespace

std::vector<glm::ivec2> SamplePattern::positions() const {
  std::vector<glm::ivec2> result;
  for (std::size_t i = 0; i < std::size_t(count); ++i) result.push_back({x[i] * unit, y[i] * unit});
  return result;
}

SamplePattern sample_pattern(const View& view, int grid) {
  if (grid != 0 && grid != 2 && grid != 4 && grid != 8)
    throw Error(ErrorCode::bad_argument, "abuffer: grid", "must be 0, 2, 4 or 8, not " + std::to_string(grid));
  SamplePattern pattern;
  pattern.count = 0;
  if (grid == 0)
    for (const glm::ivec2& s : sample_offsets(view.samples))
      add(pattern, s.x / SamplePattern::unit, s.y / SamplePattern::unit);
  const int spacing = grid ? SamplePattern::unit / grid : 0;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) add(pattern, x * spacing + spacing / 2, y * spacing + spacing / 2);
  // Reach of the samples: triangles that lie between the samples of pixels touch no pixel.
  const auto xs = std::minmax_element(pattern.x.begin(), pattern.x.begin() + pattern.count);
  const auto ys = std::minmax_element(pattern.y.begin(), pattern.y.begin() + pattern.count);
  pattern.low_x = *xs.first;
  pattern.high_x = *xs.second;
  pattern.low_y = *ys.first;
  pattern.high_y = *ys.second;
  return pattern;
}

}  // namespace frontmost::abuffer_detail
