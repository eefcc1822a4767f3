// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/figure_traps.h"

#include <algorithm>

#include "base/float_environment.h"
#include "painter/traps/make_traps.h"

namespace frontmost::shading {
namespace {

using painter_detail::ScreenPolygon;
using painter_detail::TrapList;

/// In groups of those that look the same. All of a group hides, or none.
std::vector<ScreenPolygon> polygons_in_groups(const ColoredOrder& colored, const Occluders& occluders) {
  std::vector<ScreenPolygon> polygons;
  polygons.reserve(colored.polygons.size());
  std::vector<std::uint8_t> hide;  // by group
  const PaintPolygon* before = nullptr;
  glm::u8vec4 color_before(0);
  for (const ColoredShape& shape : colored.shapes) {
    bool is_first = true;
    for (const PaintPolygon& polygon : colored.polygons_of(shape)) {
      const bool is_same_part = before && before->id == polygon.id && color_before == shape.color;
      if (is_first && !is_same_part) hide.push_back(1);
      hide.back() = hide.back() && shape.color.a == 255 && occluders.contain(polygon.id);
      polygons.push_back({colored.corners_of(polygon), std::uint32_t(hide.size() - 1)});
      is_first = false;
      before = &polygon;
    }
    color_before = shape.color;
  }
  for (ScreenPolygon& polygon : polygons) polygon.is_occluder = hide[polygon.group] != 0;
  return polygons;
}

/// Consecutive shapes of one sheet.
struct PaintedSheet {
  std::size_t begin, end;  ///< of ColoredOrder::polygons
  bool has_traps;          ///< translucent, and of several shapes
};

std::vector<PaintedSheet> sheets_of(const ColoredOrder& colored) {
  std::vector<PaintedSheet> sheets;
  const ColoredShape* first = nullptr;
  for (const ColoredShape& shape : colored.shapes) {
    const std::size_t end = shape.first_polygon + shape.polygon_count;
    if (first && first->sheet == shape.sheet) {
      sheets.back() = {sheets.back().begin, end, shape.color.a < 255};
    } else {
      sheets.push_back({shape.first_polygon, end, false});
      first = &shape;
    }
  }
  return sheets;
}

}  // namespace

TrapList figure_traps(const ColoredOrder& colored, double width, const Occluders& occluders,
                      const Execution& execution) {
  const IeeeScope ieee;
  std::vector<ScreenPolygon> polygons = polygons_in_groups(colored, occluders);
  TrapList opaque = painter_detail::make_traps(polygons, colored.view, width, execution);
  const std::vector<PaintedSheet> sheets = sheets_of(colored);
  if (std::none_of(sheets.begin(), sheets.end(), [](const PaintedSheet& sheet) { return sheet.has_traps; }))
    return opaque;
  for (ScreenPolygon& polygon : polygons) polygon.is_occluder = true;
  TrapList all;
  for (const PaintedSheet& sheet : sheets) {
    const std::span<const ScreenPolygon> members(polygons.data() + sheet.begin, sheet.end - sheet.begin);
    const TrapList own =
        sheet.has_traps ? painter_detail::make_traps(members, colored.view, width, execution) : TrapList();
    for (std::size_t i = sheet.begin; i < sheet.end; ++i)
      sheet.has_traps ? all.add_polygon(own, i - sheet.begin) : all.add_polygon(opaque, i);
  }
  return all;
}

}  // namespace frontmost::shading
