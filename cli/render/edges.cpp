// SPDX-License-Identifier: Apache-2.0
// render --edges: which pictures may have edges, and the edges of a view.
#include "cli/render/edges.h"

#include <frontmost/lines.h>
#include <frontmost/sheets.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/render/output_writer.h"

namespace frontmost::cli {
namespace {

constexpr float ink = 0.1f;          // sRGB of edges
constexpr double usual_share = 900;  // the picture's shorter side in widths of a pen

double width_of(const Job& job, const View& view) {
  return job.output.edge_width.value_or(std::max(1.0, std::min(view.width, view.height) / usual_share));
}

}  // namespace

void check_edges(const Settings& settings, const Job& job) {
  if (!job.output.edges) {
    if (job.output.edge_width) throw UsageError("--edge-width needs --edges");
    return;
  }
  const auto refuse = [](const char* why) { throw UsageError(std::string("--edges: ") + why); };
  if (settings.run.stream) refuse("edges need the whole model at once; leave out --stream");
  if (settings.view.camera_model != CameraModel::pinhole)
    refuse("edges need a pinhole camera; leave out --camera-model");
  if (settings.view.depth.is_used) refuse("edges are hidden exactly, without the options of a depth buffer");
  if (settings.view.culling != Culling::none) refuse("all surfaces hide edges; leave out --cull");
  if (!job.layer_files.empty()) refuse("layers have no edges; leave out --layers");
  const auto is_deep = [](const FileToWrite& file) {
    return std::find(file.kinds.begin(), file.kinds.end(), OutputKind::deep) != file.kinds.end();
  };
  if (std::any_of(job.files.begin(), job.files.end(), is_deep)) refuse("deep files have no edges; leave out --deep");
  // Without any result, the terminal shows the picture.
  const bool has_result = !job.files.empty() || job.output.hash || settings.run.json;
  if (has_result && !writes_colors(job) && !job.output.reference)
    refuse("there is no picture to draw edges over, and files of --depth, --ids and --normals have none; add -o");
}

Strokes edges_of(const RenderContext& context, const View& view) {
  const Drawing drawing = context.line_drawer->draw(view, {.ripples = false}, context.execution);
  const StrokeOptions strokes{.with_hidden = false, .by_kind = false, .by_outline = false, .by_instance = false};
  return chain_strokes(context.surfaces, drawing, strokes, context.execution);
}

void add_edges(Image& picture, const Strokes& edges, const Job& job, const View& view, const Execution& execution) {
  draw_strokes(picture, edges, {width_of(job, view), glm::vec3(ink), job.output.blend}, execution);
}

void add_edges(Page& page, const Strokes& edges, const Job& job, const RenderContext& context, const View& view) {
  const double millimetres = page.width / view.width;
  const auto gray = std::uint8_t(ink * 255 + 0.5f);
  LinePens pens;
  pens.seen = {width_of(job, view) * millimetres, {gray, gray, gray}};
  pens.crease = pens.seen;
  SheetView placed;
  placed.strokes = edges;
  placed.millimetres_per_pixel = millimetres;
  for (PageLayer& layer : page_of(context.surfaces, {&placed, 1}, pens, {page.width, page.height}).layers) {
    layer.name = "edges";
    for (PageGroup& group : layer.groups) group.name.clear();
    page.layers.push_back(std::move(layer));
  }
}

}  // namespace frontmost::cli
