// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/check_figure.h"

#include <algorithm>
#include <string>

namespace frontmost::shading {
namespace {

[[noreturn]] void refuse(const char* why) { throw Error(ErrorCode::bad_argument, std::string("figure: ") + why); }

void check_corners(const PaintOrder& order) {
  for (const PaintPolygon& polygon : order.polygons)
    if (polygon.corner_count < 3 || polygon.corner_count > order.corners.size() ||
        polygon.first_corner > order.corners.size() - polygon.corner_count)
      refuse("a polygon has fewer than three corners, or corners that are not there");
}

}  // namespace

void check_figure(const ColoredOrder& colored) {
  const std::size_t count = colored.order.polygons.size();
  if (colored.colors.size() != count || colored.shapes.size() != count)
    refuse("colours, shapes and polygons differ in number");
  check_corners(colored.order);
  const std::vector<std::uint32_t>& sheets = colored.sheets;
  if (sheets.empty()) return;
  if (sheets.size() != count) refuse("sheets and polygons differ in number");
  for (std::size_t i = 1; i < count; ++i)
    if (sheets[i] == sheets[i - 1] && colored.colors[i].a != colored.colors[i - 1].a)
      refuse("a sheet has more than one opacity");
}

}  // namespace frontmost::shading
