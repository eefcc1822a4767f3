// SPDX-License-Identifier: Apache-2.0
// Outlines of a figure's shapes, with traps under later shapes:
//
//   ColoredOrder --polygons in groups--> make_traps() --> TrapList
//        |                                                   |
//        +-- polygons of a shape, their sides with traps ----+--> SideNet --> rings --> Figure
//            cancelled out where two share them                  (one polygon is a ring as it is)
#include <algorithm>

#include "base/parallel.h"
#include "figures/colored_order.h"
#include "figures/side_net.h"
#include "painter/traps/trap.h"

namespace frontmost {
namespace {

using namespace shading;
using painter_detail::make_traps;
using painter_detail::ScreenPolygon;
using painter_detail::TrapList;
using painter_detail::TrappedCorner;

/// Polygons with a group number; a group looks the same everywhere. All polygons of a group hide, or none.
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

/// Consecutive shapes of one blend group.
struct PaintedGroup {
  std::size_t begin, end;  ///< range of ColoredOrder::polygons
  bool has_traps;          ///< translucent, with several shapes
};

std::vector<PaintedGroup> groups_of(const ColoredOrder& colored) {
  std::vector<PaintedGroup> groups;
  const ColoredShape* first = nullptr;
  for (const ColoredShape& shape : colored.shapes) {
    const std::size_t end = shape.first_polygon + shape.polygon_count;
    if (first && first->blend_group == shape.blend_group) {
      groups.back() = {groups.back().begin, end, shape.color.a < 255};
    } else {
      groups.push_back({shape.first_polygon, end, false});
      first = &shape;
    }
  }
  return groups;
}

/// The traps of each polygon. Opaque polygons have traps under later ones, translucent ones under others of their blend
/// group. Polygons of the same shape hide a trap, and so do parts of the same primitive with the same colour.
TrapList find_traps(const ColoredOrder& colored, double width, const Occluders& occluders, const Execution& execution) {
  std::vector<ScreenPolygon> polygons = polygons_in_groups(colored, occluders);
  TrapList opaque = make_traps(polygons, colored.view, width, execution);
  const std::vector<PaintedGroup> groups = groups_of(colored);
  if (std::none_of(groups.begin(), groups.end(), [](const PaintedGroup& group) { return group.has_traps; }))
    return opaque;
  for (ScreenPolygon& polygon : polygons) polygon.is_occluder = true;
  TrapList all;
  for (const PaintedGroup& group : groups) {
    const std::span<const ScreenPolygon> members(polygons.data() + group.begin, group.end - group.begin);
    const TrapList own = group.has_traps ? make_traps(members, colored.view, width, execution) : TrapList();
    for (std::size_t i = group.begin; i < group.end; ++i)
      group.has_traps ? all.add_polygon(own, i - group.begin) : all.add_polygon(opaque, i);
  }
  return all;
}

/// Writes outlines with their traps into a figure.
class Outliner {
 public:
  Outliner(Figure& figure, const TrapList& traps) : figure_(figure), traps_(traps) {}

  void begin_shape(const glm::u8vec4& color, bool is_in_last_group) {
    const std::uint32_t group = figure_.shapes.empty() ? 0 : figure_.shapes.back().blend_group + !is_in_last_group;
    figure_.shapes.push_back({color, 0, figure_.rings.size(), group});
  }
  void add_ring(std::span<const TrappedCorner> outline) {
    const std::size_t first = figure_.corners.size();
    write_outline(traps_, outline, figure_.corners);
    figure_.rings.push_back({first, std::uint32_t(figure_.corners.size() - first)});
    ++figure_.shapes.back().ring_count;
  }

 private:
  Figure& figure_;
  const TrapList& traps_;
};

}  // namespace

Figure outlined(const ColoredOrder& colored, double width, const Occluders& occluders, const Execution& execution) {
  const IeeeScope ieee;
  const TrapList traps = find_traps(colored, width, occluders, execution);
  Figure figure;
  figure.view = colored.view;
  figure.shapes.reserve(colored.shapes.size());
  figure.rings.reserve(colored.shapes.size());
  figure.corners.reserve(colored.corners.size() * 2);  // about what traps add
  Outliner outliner(figure, traps);
  SideNet net;
  std::vector<TrappedCorner> corners;
  const ColoredShape* before = nullptr;
  for (const ColoredShape& shape : colored.shapes) {
    check_cancelled(execution);
    outliner.begin_shape(shape.color, before && shape.color.a < 255 && before->blend_group == shape.blend_group);
    before = &shape;
    net.clear();
    for (std::size_t i = shape.first_polygon; i < shape.first_polygon + shape.polygon_count; ++i) {
      traps.set_corners(i, colored.corners_of(colored.polygons[i]), corners);
      if (shape.polygon_count > 1) net.add(corners, std::uint32_t(i));
    }
    if (shape.polygon_count == 1) {
      outliner.add_ring(corners);
      continue;
    }
    net.weave();
    net.for_each_ring([&](std::span<const TrappedCorner> ring) { outliner.add_ring(ring); });
  }
  return figure;
}

}  // namespace frontmost
