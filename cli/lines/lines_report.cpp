// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/lines_report.h"

#include <array>

#include "cli/lines/paper.h"

namespace frontmost::cli {
namespace {

constexpr std::array<std::string_view, edge_kind_count> kind_names = {"boundary", "silhouette", "border", "crease",
                                                                      "intersection"};

Json view_json(const DrawnView& view) {
  std::array<std::size_t, edge_kind_count> edges{};
  for (const DrawnEdge& edge : view.drawing.edges) ++edges[std::size_t(edge.kind)];
  Json kinds = Json::object();
  for (std::size_t i = 0; i < edges.size(); ++i) kinds[std::string(kind_names[i])] = edges[i];
  double seen = 0, hidden = 0;
  for (const DrawnPart& part : view.drawing.parts)
    (part.hidden_by != 0 ? hidden : seen) += glm::distance(part.from, part.to) * view.sheet.millimetres_per_pixel;
  return {{"name", view.name},
          {"edges", view.drawing.edges.size()},
          {"edges_by_kind", kinds},
          {"parts", view.drawing.parts.size()},
          {"strokes", view.sheet.strokes.strokes.size()},
          {"centre_lines", view.sheet.centre_lines.size()},
          {"visible_mm", seen},
          {"hidden_mm", hidden}};
}

}  // namespace

Json lines_json(const Settings& settings, const std::vector<DrawnView>& views, const Page& page,
                std::optional<double> scale, const LinesTimings& timings) {
  Json json = {{"model", settings.model}, {"page_mm", {page.width, page.height}}};
  json["scale"] = scale ? Json(*scale) : Json(nullptr);
  json["scale_text"] = scale ? Json(scale_text(*scale)) : Json(nullptr);
  json["views"] = Json::array();
  for (const DrawnView& view : views) json["views"].push_back(view_json(view));
  json["layers"] = Json::array();
  for (const PageLayer& layer : page.layers) {
    const PenTravel one = travel_of({page.width, page.height, "", {layer}});
    json["layers"].push_back({{"name", layer.name}, {"paths", one.paths}, {"drawn_mm", one.down}});
  }
  const PenTravel all = travel_of(page);
  json["paths"] = all.paths;
  json["points"] = all.points;
  json["arcs"] = all.arcs;
  json["drawn_mm"] = all.down;
  json["moved_mm"] = all.up;
  json["outputs"] = settings.drawing.outputs;
  json["timings_ms"] = {{"lines", timings.lines},
                        {"rounds", timings.rounds},
                        {"strokes", timings.strokes},
                        {"tones", timings.tones},
                        {"write", timings.write}};
  return json;
}

}  // namespace frontmost::cli
