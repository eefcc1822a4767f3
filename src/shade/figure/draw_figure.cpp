// SPDX-License-Identifier: Apache-2.0
// The whole way from surfaces to a figure: the painter's order, what is seen of it, colours, shapes and outlines.
#include <functional>

#include "frontmost/shade.h"
#include "frontmost/zbuffer.h"
#include "shade/figure/colored_order.h"

namespace frontmost {
namespace {

/// Pixels that a polygon reaches under its neighbours, against the hairlines of viewers that blend rims. No lines
/// around polygons: they make everything wider, in poppler by much more than they are wide.
constexpr double kHem = 4;

using Hides = std::function<bool(PrimitiveId)>;

/// Of which triangles nothing behind is seen: neither through them nor, as long as holes are not cut out, through
/// their holes.
Hides hiding(const Surfaces& surfaces, const FigureOptions& options, bool has_cut_holes) {
  const bool is_clear = options.shade.opacity < 1;
  return [=, &surfaces](PrimitiveId id) {
    const Scene& scene = surfaces.scene();
    const PrimitiveSource source = surfaces.source(id);
    const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
    const Material::Alpha alpha = material == no_index ? Material::Alpha::opaque : scene.materials[material].alpha;
    return !is_clear && (alpha == Material::Alpha::opaque || (has_cut_holes && alpha == Material::Alpha::mask));
  };
}

PaintOrder order_of(const Surfaces& surfaces, const View& view, const FigureOptions& options,
                    const Execution& execution) {
  if (!options.visible_only) return painter(surfaces, view, {}, execution);
  const Hides hides = hiding(surfaces, options, false);
  return visible_parts(painter(surfaces, view, {.hides = hides}, execution), hides, execution);
}

void check_count(std::size_t polygons, const FigureOptions& options) {
  if (polygons <= options.most_polygons) return;
  throw Error(ErrorCode::limit_exceeded,
              "figure: " + std::to_string(polygons) + " polygons, more than " + std::to_string(options.most_polygons));
}

}  // namespace

Figure draw_figure(const Surfaces& surfaces, const Visible& visible, const FigureOptions& options,
                   const Execution& execution) {
  if (visible.view.samples != 1)
    throw Error(ErrorCode::bad_argument, "figure: what is visible must have one sample a pixel");
  const PaintOrder order = order_of(surfaces, visible.view, options, execution);
  check_count(order.polygons.size(), options);
  const ColorOptions coloring{options.shade, options.tolerance, options.merges_neighbours, options.most_polygons};
  ColoredOrder colored = color_order(surfaces, visible, order, coloring, execution);
  if (options.merges_neighbours) colored = merge_neighbours(colored, execution);
  colored = gather_sheets(std::move(colored), execution);
  Figure figure = outlined(colored, kHem, hiding(surfaces, options, true), execution);
  figure.title = surfaces.scene().name;
  figure.background = options.shade.background;
  return figure;
}

Figure draw_figure(const Surfaces& surfaces, const View& view, const FigureOptions& options,
                   const Execution& execution) {
  View with_one_sample = view;
  with_one_sample.samples = 1;
  return draw_figure(surfaces, zbuffer(surfaces, with_one_sample, execution), options, execution);
}

}  // namespace frontmost
