// SPDX-License-Identifier: Apache-2.0
// render -o FILE.svg or .pdf: a picture of polygons, painted one over the other.
//
// A figure needs visibility only at pixel centres, so it reuses the visibility that maps have found. The sizes of files
// are printed before they are written, because a model of a million triangles makes a file that few viewers open.
#include <fmt/format.h>
#include <frontmost/pictures.h>
#include <frontmost/sheets.h>
#include <frontmost/zbuffer.h>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/render/blank.h"
#include "cli/render/edges.h"
#include "cli/render/output_writer.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

FigureOptions figure_options(const Job& job, const RenderContext& context) {
  return {shade_options(job, context), job.output.color_tolerance, job.output.visible_only,
          job.output.merges_neighbours, job.output.most_polygons};
}

/// Whether the z-buffer has determined visibility at pixel centres already.
bool is_there(const Job& job, const RenderContext& context, const Sights& sights) {
  return !context.run.method && !job.view.depth.is_used && (sights.shared || sights.maps);
}
Visible seen_at_centres(const RenderContext& context, View view) {
  view.samples = 1;
  return zbuffer(context.surfaces, view, context.execution);
}

/// Returns the polygons in the colours of a picture with the same options. \throws Error that names the file and the
/// option, if there are too many polygons.
Figure figure_of(const Job& job, const RenderContext& context, const Sights& sights, const View& view) {
  const FigureOptions options = figure_options(job, context);
  std::optional<Visible> seen;
  if (!is_there(job, context, sights)) seen = seen_at_centres(context, view);
  try {
    Figure figure =
        draw_figure(context.shader, {.visible = seen ? &*seen : &sights.for_maps().visible, .index = context.index},
                    options, context.execution);
    figure.title = job.name;
    return figure;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::limit_exceeded || error.place() != "figure") throw;
    throw Error(error.code(), job.figures.front(), "", error.reason() + "; see --most-polygons");
  }
}

/// Prints the files' approximate sizes in megabytes, from the average sizes of a path and of a vertex.
void tell_size(const Job& job, const Figure& figure) {
  for (const std::string& path : job.figures) {
    const bool is_svg = page_format(path) == PageFormat::svg;
    const auto shapes = double(figure.shapes.size()), corners = double(figure.corners.size());
    const double bytes = is_svg ? 32 * shapes + 9 * corners : 8 * shapes + 5 * corners;
    complain(fmt::format("{}: {} shapes, about {:.1f} MB", path, figure.shapes.size(), bytes / 1e6));
  }
}

}  // namespace

bool is_figure(const std::string& path) {
  const std::optional<PageFormat> format = page_format(path);
  return format == PageFormat::svg || format == PageFormat::pdf;
}

void write_figures(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result) {
  if (job.figures.empty()) return;
  Stopwatch watch;
  const Figure figure = figure_of(job, context, sights, result.view);
  Page page = page_of(figure);
  if (sights.edges) add_edges(page, *sights.edges, job, context, result.view);
  result.timings.shade += watch.milliseconds();
  if (job.output.background && !sights.has_edges() && nothing_stands_out(figure, *job.output.background))
    result.warnings.push_back(contrast_warning(false));
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
