// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/lines_report.h"

#include <array>

#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr std::array<std::string_view, edge_kind_count> kind_names = {"boundary", "silhouette", "border", "crease",
                                                                      "intersection"};

Json view_json(const DrawnView& view, const std::string& name) {
  std::array<std::size_t, edge_kind_count> edges{};
  for (const DrawnEdge& edge : view.drawing.edges) ++edges[std::size_t(edge.kind)];
  Json kinds = Json::object();
  for (std::size_t i = 0; i < edges.size(); ++i) kinds[std::string(kind_names[i])] = edges[i];
  double seen = 0, hidden = 0;
  for (const DrawnPart& part : view.drawing.parts)
    (part.hidden_by != 0 ? hidden : seen) += glm::distance(part.from, part.to) * view.placed.millimetres_per_pixel;
  return {{"name", name},
          {"edges", view.drawing.edges.size()},
          {"edges_by_kind", kinds},
          {"parts", view.drawing.parts.size()},
          {"strokes", view.placed.strokes.strokes.size()},
          {"centre_lines", view.placed.centre_lines.size()},
          {"visible_mm", seen},
          {"hidden_mm", hidden}};
}

}  // namespace

Json lines_json(const Settings& settings, const Sheet& sheet, const Page& page, const StepTimes& times) {
  Json json = {{"model", settings.model}, {"page_mm", {page.width, page.height}}};
  json["scale"] = sheet.scale ? Json(*sheet.scale) : Json(nullptr);
  json["scale_text"] = sheet.scale ? Json(scale_text(*sheet.scale)) : Json(nullptr);
  json["views"] = Json::array();
  for (const DrawnView& view : sheet.views)
    json["views"].push_back(view_json(view, view.name.empty() ? view_name(settings.view) : view.name));
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
  json["timings_ms"] = {{"lines", times.milliseconds().at("views")},
                        {"rounds", times.milliseconds().at("rounds")},
                        {"strokes", times.milliseconds().at("layout")},
                        {"tones", times.milliseconds().at("tones")},
                        {"write", times.milliseconds().at("page")}};
  return json;
}

}  // namespace frontmost::cli
