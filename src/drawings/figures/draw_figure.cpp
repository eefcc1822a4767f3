// SPDX-License-Identifier: Apache-2.0
// All steps from surfaces to a figure: painting order, visibility, colours, shapes and outlines.
//
//    surfaces --painter()--> order --visible_parts()--> parts --colours, shapes, outlines (colored_order.h)--> Figure
//
// Occluders are determined twice. Before colouring, a triangle whose texture has holes hides nothing, because its
// polygon still covers the holes. After colouring, the rest of the triangle hides what is behind.
#include <algorithm>

#include "base/parallel.h"
#include "figures/colored_order.h"
#include "figures/side_net.h"
#include "frontmost/sheets.h"
#include "frontmost/zbuffer.h"
#include "painter/traps/traps.h"
#include "shade/prepared_scene.h"
#include "view/answer.h"

namespace frontmost {
namespace {

using namespace shading;
using painter_detail::make_traps;
using painter_detail::ScreenPolygon;
using painter_detail::TrapList;
using painter_detail::TrappedCorner;

/// The polygons of all shapes, each with the number of its group. The polygons of a group have one colour, and either
/// all of them are occluders or none is.
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

/// The traps of each polygon. An opaque polygon has traps under later polygons, a translucent one under other polygons
/// of its blend group. A trap may also lie under polygons of the same shape, and under parts of the same primitive that
/// have the same colour.
TrapList find_traps(const ColoredOrder& colored, double width, const Occluders& occluders, const Execution& execution) {
  std::vector<ScreenPolygon> polygons = polygons_in_groups(colored, occluders);
  TrapList opaque = make_traps(polygons, colored.view, width, execution);
  const std::vector<ColoredShape>& shapes = colored.shapes;
  const auto is_translucent = [](const ColoredShape& shape) { return shape.color.a < 255; };
  if (std::none_of(shapes.begin(), shapes.end(), is_translucent)) return opaque;
  for (ScreenPolygon& polygon : polygons) polygon.is_occluder = true;
  TrapList all;
  for (std::size_t first = 0, next; first < shapes.size(); first = next) {
    for (next = first + 1; next < shapes.size() && shapes[next].blend_group == shapes[first].blend_group;) ++next;
    const std::size_t begin = shapes[first].first_polygon;
    const std::size_t end = shapes[next - 1].first_polygon + shapes[next - 1].polygon_count;
    const bool has_traps = next > first + 1 && is_translucent(shapes[next - 1]);
    const std::span<const ScreenPolygon> members(polygons.data() + begin, end - begin);
    const TrapList own = has_traps ? make_traps(members, colored.view, width, execution) : TrapList();
    for (std::size_t i = begin; i < end; ++i) has_traps ? all.add_polygon(own, i - begin) : all.add_polygon(opaque, i);
  }
  return all;
}

/// Pixels that a polygon reaches under its neighbours, against hairlines in viewers that blend edges. Lines around
/// polygons would widen everything, in poppler by much more than their width.
constexpr double kTrap = 4;

Occluders occluders_of(const Surfaces& surfaces, const FigureOptions& options, bool holes_are_cut_out) {
  if (options.shade.opacity < 1) return Occluders::none();
  return Occluders::where(
      [&surfaces, holes_are_cut_out](PrimitiveId id) { return is_opaque(surfaces, id, holes_are_cut_out); });
}

VisibleParts parts_of(const Surfaces& surfaces, const View& view, const FigureOptions& options,
                      const Execution& execution) {
  if (options.visible_only) {
    const Occluders occluders = occluders_of(surfaces, options, false);
    return visible_parts(painter(surfaces, view, {.occluders = occluders}, execution), occluders, execution);
  }
  PaintOrder order = painter(surfaces, view, {}, execution);
  // Whether any polygon reaches beyond the picture. Near the eye, polygons are millions of pixels wide, and all these
  // pixels would be sampled.
  const auto is_outside = [&](const PaintCorner& corner) {
    return !(corner.at.x > -1 && corner.at.y > -1 && corner.at.x < view.width + 1 && corner.at.y < view.height + 1);
  };
  if (std::any_of(order.corners.begin(), order.corners.end(), is_outside))
    return visible_parts(order, Occluders::none(), execution);
  return {order.view, std::move(order.polygons), std::move(order.corners)};
}

Figure figure_of(shading::PreparedScene& scene, const ShadeInput& input, const FigureOptions& options,
                 const Execution& execution) {
  const Surfaces& surfaces = scene.surfaces;
  shading::check_given(input, "figure");
  if (!input.visible) throw Error(ErrorCode::unsupported, "figure", "needs the planes of a Visible");
  check_planes(*input.visible, "figure");
  shading::check_opacity(options.shade);
  if (input.view().samples != 1)
    throw Error(ErrorCode::bad_argument, "figure", "the Visible must have one sample a pixel");
  if (!(options.tolerance >= 0 && options.tolerance <= 255))
    throw Error(ErrorCode::bad_argument, "figure: tolerance", "must be 0 to 255");
  const VisibleParts parts = parts_of(surfaces, input.first().view, options, execution);
  if (parts.polygons.size() > options.most_polygons)
    throw Error(
        ErrorCode::limit_exceeded, "figure",
        std::to_string(parts.polygons.size()) + " polygons, more than " + std::to_string(options.most_polygons));
  ColoredOrder colored = color_order(scene, input, parts, options, execution);
  if (options.merges_neighbours) colored = merge_neighbours(colored, execution);
  colored = gather_blend_groups(std::move(colored), execution);
  Figure figure = outlined(colored, kTrap, occluders_of(surfaces, options, true), execution);
  figure.title = surfaces.scene().name;
  figure.background = options.shade.background;
  return figure;
}

}  // namespace

Figure outlined(const ColoredOrder& colored, double width, const Occluders& occluders, const Execution& execution) {
  const IeeeScope ieee;
  const TrapList traps = find_traps(colored, width, occluders, execution);
  Figure figure;
  figure.view = colored.view;
  figure.shapes.reserve(colored.shapes.size());
  figure.rings.reserve(colored.shapes.size());
  figure.corners.reserve(colored.corners.size() * 2);  // about what traps add
  const auto add_ring = [&](std::span<const TrappedCorner> outline) {
    const std::size_t first = figure.corners.size();
    write_outline(traps, outline, figure.corners);
    figure.rings.push_back({first, std::uint32_t(figure.corners.size() - first)});
    ++figure.shapes.back().ring_count;
  };
  SideNet net;
  std::vector<TrappedCorner> corners;
  const ColoredShape* before = nullptr;
  for (const ColoredShape& shape : colored.shapes) {
    check_cancelled(execution);
    const bool is_in_last_group = before && shape.color.a < 255 && before->blend_group == shape.blend_group;
    const std::uint32_t group = before ? figure.shapes.back().blend_group + !is_in_last_group : 0;
    figure.shapes.push_back({shape.color, 0, figure.rings.size(), group});
    before = &shape;
    net.clear();
    for (std::size_t i = shape.first_polygon; i < shape.first_polygon + shape.polygon_count; ++i) {
      traps.set_corners(i, colored.corners_of(colored.polygons[i]), corners);
      if (shape.polygon_count > 1) net.add(corners, std::uint32_t(i));
    }
    if (shape.polygon_count == 1) {
      add_ring(corners);
      continue;
    }
    net.weave();
    net.for_each_ring(add_ring);
  }
  return figure;
}

Figure draw_figure(const Surfaces& surfaces, const ShadeInput& input, const FigureOptions& options,
                   const Execution& execution) {
  shading::PreparedScene scene(surfaces);
  return figure_of(scene, input, options, execution);
}

Figure draw_figure(Shader& shader, const ShadeInput& input, const FigureOptions& options, const Execution& execution) {
  return figure_of(shading::prepared(shader, execution), input, options, execution);
}

Figure draw_figure(const Surfaces& surfaces, const Visible& visible, const FigureOptions& options,
                   const Execution& execution) {
  return draw_figure(surfaces, ShadeInput{.visible = &visible}, options, execution);
}

Figure draw_figure(const Surfaces& surfaces, const View& view, const FigureOptions& options,
                   const Execution& execution) {
  View with_one_sample = view;
  with_one_sample.samples = 1;
  return draw_figure(surfaces, zbuffer(surfaces, with_one_sample, execution), options, execution);
}

}  // namespace frontmost
