// SPDX-License-Identifier: Apache-2.0
// All steps from surfaces to a figure: painting order, visibility, colours, shapes and outlines.
//
//    surfaces --painter()--> order --visible_parts()--> parts --colours, shapes, outlines (colored_order.h)--> Figure
//
// Occluders are determined twice, with different results. Before colouring, a triangle whose texture has holes hides
// nothing, because its polygon still covers the holes. After colouring, the holes are cut out, and the rest of the
// triangle hides what is behind.
#include <algorithm>

#include "figures/colored_order.h"
#include "frontmost/sheets.h"
#include "frontmost/zbuffer.h"
#include "shade/picture_parts.h"
#include "shade/prepared_scene.h"
#include "view/answer.h"

namespace frontmost {
namespace {

/// Pixels that a polygon reaches under its neighbours, against hairlines in viewers that blend edges. Lines around
/// polygons are no alternative: they widen everything, in poppler by much more than their width.
constexpr double kTrap = 4;

/// A triangle with holes is no occluder until the holes are cut out.
enum class Holes : std::uint8_t { in_triangles, cut_out };

Occluders occluders_of(const Surfaces& surfaces, const FigureOptions& options, Holes holes) {
  if (options.shade.opacity < 1) return Occluders::none();
  return Occluders::where([&surfaces, holes](PrimitiveId id) {
    const Scene& scene = surfaces.scene();
    const PrimitiveSource source = surfaces.source(id);
    const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
    if (material == no_index) return true;
    const Material& m = scene.materials[material];
    return !m.is_see_through() && (m.alpha == Material::Alpha::opaque || holes == Holes::cut_out);
  });
}

/// Near the eye polygons are millions of pixels wide, and all of these would be sampled.
bool reaches_beyond_picture(const PaintOrder& order) {
  const glm::dvec2 size(order.view.width, order.view.height);
  return std::any_of(order.corners.begin(), order.corners.end(), [&](const PaintCorner& corner) {
    return !(corner.at.x > -1 && corner.at.y > -1 && corner.at.x < size.x + 1 && corner.at.y < size.y + 1);
  });
}

/// All polygons of an order within the picture, hidden or not.
VisibleParts all_parts(PaintOrder order, const Execution& execution) {
  if (reaches_beyond_picture(order)) return visible_parts(order, Occluders::none(), execution);
  return {order.view, std::move(order.polygons), std::move(order.corners)};
}

VisibleParts parts_of(const Surfaces& surfaces, const View& view, const FigureOptions& options,
                      const Execution& execution) {
  if (!options.visible_only) return all_parts(painter(surfaces, view, {}, execution), execution);
  const Occluders occluders = occluders_of(surfaces, options, Holes::in_triangles);
  return visible_parts(painter(surfaces, view, {.occluders = occluders}, execution), occluders, execution);
}

void check_count(std::size_t polygons, const FigureOptions& options) {
  if (polygons <= options.most_polygons) return;
  throw Error(ErrorCode::limit_exceeded, "figure",
              std::to_string(polygons) + " polygons, more than " + std::to_string(options.most_polygons));
}

/// Draws a figure with the data that earlier pictures prepared.
Figure figure_of(shading::PreparedScene& scene, const ShadeInput& input, const FigureOptions& options,
                 const Execution& execution) {
  const Surfaces& surfaces = scene.surfaces;
  shading::check_given(input, "figure");
  if (!input.visible) throw Error(ErrorCode::unsupported, "figure", "needs the planes of a Visible");
  check_planes(*input.visible, "figure");
  shading::check_opacity(options.shade);
  if (input.view().samples != 1)
    throw Error(ErrorCode::bad_argument, "figure", "what is visible must have one sample a pixel");
  if (!(options.tolerance >= 0 && options.tolerance <= 255))
    throw Error(ErrorCode::bad_argument, "figure: tolerance", "must be 0 to 255");
  const VisibleParts parts = parts_of(surfaces, input.first().view, options, execution);
  check_count(parts.polygons.size(), options);
  ColoredOrder colored = color_order(scene, input, parts, options, execution);
  if (options.merges_neighbours) colored = merge_neighbours(colored, execution);
  colored = gather_blend_groups(std::move(colored), execution);
  Figure figure = outlined(colored, kTrap, occluders_of(surfaces, options, Holes::cut_out), execution);
  figure.title = surfaces.scene().name;
  figure.background = options.shade.background;
  return figure;
}

}  // namespace

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
