// SPDX-License-Identifier: Apache-2.0
#include "cli/render/figure.h"

#include <fmt/format.h>
#include <frontmost/figure.h>
#include <frontmost/page.h>
#include <frontmost/zbuffer.h>

#include <functional>
#include <span>

#include "cli/console.h"
#include "cli/interruption.h"
#include "cli/render/contrast.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

/// A pixel as style sheets define it, so that a figure is as large on a page as the picture in a browser.
constexpr double kMillimetres = 25.4 / 96;
/// Pixels that a polygon reaches under its neighbours, against the hairlines of viewers that blend rims. No lines
/// around polygons: they make everything wider, in poppler by much more than they are wide.
constexpr double kHem = 4;

Material::Alpha alpha_of(const Surfaces& surfaces, PrimitiveId id) {
  const Scene& scene = surfaces.scene();
  const PrimitiveSource source = surfaces.source(id);
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  return material == no_index ? Material::Alpha::opaque : scene.materials[material].alpha;
}

/// Of which triangles nothing behind is seen: neither through them nor, as long as holes are not cut out, through
/// their holes.
std::function<bool(PrimitiveId)> hiding(const Job& job, const RenderContext& context, bool has_cut_holes) {
  const bool is_clear = job.output.opacity < 1;
  return [=, &surfaces = context.surfaces](PrimitiveId id) {
    const Material::Alpha alpha = alpha_of(surfaces, id);
    return !is_clear && (alpha == Material::Alpha::opaque || (has_cut_holes && alpha == Material::Alpha::mask));
  };
}

PaintOrder order_of(const Job& job, const RenderContext& context, const View& view) {
  if (!job.output.visible_only) return painter(context.surfaces, view, {}, context.execution);
  const std::function<bool(PrimitiveId)> hides = hiding(job, context, false);
  return visible_parts(painter(context.surfaces, view, {.hides = hides}, context.execution), hides, context.execution);
}

/// In the colours of the picture that the same options make.
ColoredOrder colors_of(const PaintOrder& order, const Job& job, const RenderContext& context) {
  View view = order.view;
  view.samples = 1;
  const Visible visible = zbuffer(context.surfaces, view, context.execution);
  ColorOptions options;
  options.shade = shade_options(job, context);
  options.tolerance = job.output.color_tolerance;
  options.most_polygons = job.output.most_polygons;
  options.groups_pieces = job.output.merges_neighbours;
  return color_order(context.surfaces, visible, order, options, context.execution);
}

PageColor page_color(const glm::u8vec4& color) { return {color.r, color.g, color.b, color.a}; }

PageGroup backdrop(const glm::vec3& color, const Page& page) {
  PageGroup group{"background", Pen{}};
  group.pen.width = 0;
  group.add(std::array{glm::dvec2(0), glm::dvec2(page.width, 0), glm::dvec2(page.width, page.height),
                       glm::dvec2(0, page.height)},
            true);
  const auto part = [](float value) { return std::uint8_t(value * 255.0f + 0.5f); };
  group.fills.push_back({part(color.r), part(color.g), part(color.b)});
  return group;
}

/// Where a sheet of several shapes ends; of what is none, where the next one begins.
std::size_t end_of_group(std::span<const FigureShape> shapes, std::size_t begin) {
  const auto goes_on = [&](std::size_t i) { return i + 1 < shapes.size() && shapes[i + 1].sheet == shapes[i].sheet; };
  std::size_t end = begin;
  if (goes_on(begin)) {
    while (goes_on(end)) ++end;
    return end + 1;
  }
  while (end < shapes.size() && !goes_on(end)) ++end;
  return end;
}

/// Those of one sheet have their opacity together.
PageGroup group_of(const Figure& figure, std::span<const FigureShape> shapes) {
  PageGroup group{"surfaces", Pen{}};
  group.pen.width = 0;
  const bool is_sheet = shapes.size() > 1 && shapes[0].sheet == shapes[1].sheet;
  if (is_sheet) group.opacity = shapes[0].color.a;
  const FigureShape& last = shapes.back();
  const std::size_t ring_count = last.first_ring + last.ring_count - shapes[0].first_ring;
  group.paths.reserve(ring_count);
  group.fills.reserve(ring_count);
  std::vector<glm::dvec2> outline;
  for (const FigureShape& shape : shapes)
    for (std::uint32_t i = 0; i < shape.ring_count; ++i) {
      const FigureRing& ring = figure.rings[shape.first_ring + i];
      outline.clear();
      for (std::size_t k = 0; k < ring.corner_count; ++k)
        outline.push_back(figure.corners[ring.first_corner + k] * kMillimetres);
      group.add(outline, true, i > 0);
      group.fills.push_back(page_color(shape.color));
      if (is_sheet) group.fills.back().opacity = 255;
    }
  return group;
}

Page page_of(const Figure& figure, const Job& job) {
  Page page{figure.view.width * kMillimetres, figure.view.height * kMillimetres, job.name};
  PageLayer& layer = page.layers.emplace_back(PageLayer{"figure"});
  if (job.output.background) layer.groups.push_back(backdrop(*job.output.background, page));
  const std::span<const FigureShape> shapes(figure.shapes);
  for (std::size_t begin = 0, end; begin < shapes.size(); begin = end) {
    end = end_of_group(shapes, begin);
    layer.groups.push_back(group_of(figure, shapes.subspan(begin, end - begin)));
  }
  return page;
}

/// Megabytes of the files, roughly: what a path and a corner take in each.
void tell_size(const Job& job, const Figure& figure) {
  for (const std::string& path : job.figures) {
    const bool is_svg = page_format(path) == PageFormat::svg;
    const auto shapes = double(figure.shapes.size()), corners = double(figure.corners.size());
    const double bytes = is_svg ? 32 * shapes + 9 * corners : 8 * shapes + 5 * corners;
    complain(fmt::format("{}: {} shapes, about {:.1f} MB", path, figure.shapes.size(), bytes / 1e6));
  }
}

void check_size(const Job& job, const PaintOrder& order) {
  if (order.polygons.size() <= job.output.most_polygons) return;
  throw Error(ErrorCode::limit_exceeded,
              fmt::format("{}: {} polygons, more than --most-polygons {}", job.figures.front(), order.polygons.size(),
                          job.output.most_polygons));
}

}  // namespace

bool is_figure(const std::string& path) {
  const std::optional<PageFormat> format = page_format(path);
  return format == PageFormat::svg || format == PageFormat::pdf;
}

void write_figures(const Job& job, const RenderContext& context, ViewResult& result) {
  if (job.figures.empty()) return;
  Stopwatch watch;
  const PaintOrder order = order_of(job, context, result.view);
  check_size(job, order);
  ColoredOrder colored = colors_of(order, job, context);
  if (job.output.merges_neighbours) colored = merge_neighbours(colored, context.execution);
  colored = gather_sheets(std::move(colored), context.execution);
  const Figure figure = outlined(colored, kHem, hiding(job, context, true), context.execution);
  colored = {};
  const Page page = page_of(figure, job);
  result.timings.shade += watch.milliseconds();
  if (job.output.background && nothing_stands_out(figure, *job.output.background))
    result.warnings.push_back(contrast_warning());
  if (!context.run.quiet) tell_size(job, figure);
  watch = {};
  for (const std::string& path : job.figures) {
    stop_if_interrupted();
    result.results.push_back({std::string(figure_name), path, {}});
    const WritingFiles writing;
    save(page, path, std::nullopt, context.execution);
  }
  result.timings.save += watch.milliseconds();
}

}  // namespace frontmost::cli
