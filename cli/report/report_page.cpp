// SPDX-License-Identifier: Apache-2.0
// The page: the picture with the script's overlays, a table of all objects, and the graph of hiding.
//
// Without scripts, the page has picture, table and graph, but no numbers and masks of single objects.
#include "cli/report/report_page.h"

#include <fmt/format.h>
#include <frontmost/base.h>
#include <frontmost/files.h>
#include <frontmost/pictures.h>

#include <algorithm>
#include <filesystem>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/html.h"

namespace frontmost::cli {
namespace {

constexpr const char* style = R"(.look { display: grid; grid-template-columns: minmax(0, 1fr) 320px; gap: 24px;
  align-items: start; margin-top: 24px; }
.stage { position: relative; background: var(--stage); border: 1px solid var(--line); border-radius: 14px;
  overflow: hidden; }
.stage img { display: block; width: 100%; height: auto; }
#overlay { position: absolute; inset: 0; width: 100%; height: 100%; cursor: pointer; }
#panel { background: var(--card); border: 1px solid var(--line); border-radius: 14px; padding: 16px 20px;
  max-height: 80vh; overflow-y: auto; overflow-wrap: anywhere; }
#panel h2 { font-size: 1.2rem; margin: 0; }
#panel h3 { margin-top: 14px; }
#panel p { margin: 0; }
#panel .why { color: inherit; margin: 6px 0 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 1px 14px; margin: 10px 0 0;
  font-variant-numeric: tabular-nums; }
dt { color: var(--soft); }
dd { margin: 0; text-align: right; white-space: nowrap; }
ul { list-style: none; margin: 4px 0 0; padding: 0; }
#panel li { display: flex; gap: 8px; align-items: baseline; margin: 0 0 3px; font-variant-numeric: tabular-nums; }
#panel li button { flex: 1; }
.key { flex: none; width: 12px; height: 12px; border-radius: 3px; }
button { font: inherit; color: inherit; background: none; border: 0; padding: 0; text-align: left; cursor: pointer;
  text-decoration: underline; text-decoration-color: var(--line); text-underline-offset: 3px; }
.lines { white-space: pre-line; }
label { color: var(--soft); cursor: pointer; }
.scroll.table { max-height: 90vh; overflow: auto; padding-top: 0; }
table { border-collapse: separate; border-spacing: 0; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 7px 0 7px 14px; border-bottom: 1px solid var(--line); text-align: right; font-weight: 400;
  white-space: nowrap; }
th:first-child { padding-left: 0; text-align: left; position: sticky; left: 0; background: var(--card); }
th:first-child button { display: block; max-width: 16em; overflow: hidden; text-overflow: ellipsis; }
td:last-child, th:last-child { text-align: left; }
td:last-child { white-space: normal; overflow-wrap: anywhere; min-width: 17em; }
thead th { position: sticky; top: 0; background: var(--card); font-weight: 650; padding-top: 12px;
  white-space: normal; vertical-align: bottom; line-height: 1.25; }
thead th:first-child { z-index: 1; }
thead button { text-decoration: none; text-align: inherit; }
th[aria-sort="ascending"] button::after { content: " ▲"; }
th[aria-sort="descending"] button::after { content: " ▼"; }
tbody tr { cursor: pointer; }
tr.chosen > * { background: color-mix(in srgb, var(--accent) 16%, var(--card)); }
svg.graph { display: block; max-width: none; margin: 0 auto; }
.graph path { fill: none; stroke: var(--soft); opacity: 0.55; marker-end: url(#tip); }
.graph marker path { fill: var(--soft); stroke: none; opacity: 1; }
.graph path.ring { stroke-dasharray: 5 4; }
.graph path.chosen { stroke: var(--accent); opacity: 1; }
.graph rect { fill: var(--card); stroke: var(--line); }
.graph text { fill: var(--ink); font-size: 13px; text-anchor: middle; }
.node { cursor: pointer; }
.node.chosen rect { stroke: var(--accent); stroke-width: 2; }
@media (max-width: 1280px) { th:first-child button { max-width: 7em; } td:last-child { min-width: 9em; }
  th, td { padding-left: 10px; } }
@media (max-width: 860px) { .look { grid-template-columns: minmax(0, 1fr); } header, main { padding: 0 14px; }
  header { padding-top: 24px; } #panel { max-height: none; } .scroll { padding: 6px 12px; }
  th:first-child button { max-width: 8em; } }
)";

std::string name_of(const ReportRun& run, std::uint32_t object) {
  return printable_name(run.scene().instances[object].name);
}

/// Returns the map of objects, as runs. A run is the object + 1, and the number of pixels.
Json map_json(const ReportRun& run) {
  const Image ids = id_image(run.surfaces, run.visible, IdKind::object);
  Json runs = Json::array();
  const Buffer<std::uint32_t>& values = ids.channels[0].integers();
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i + 1;
    while (end < values.size() && values[end] == values[i]) ++end;
    runs.push_back(std::uint32_t(values[i] + 1));  // the id for none wraps to 0
    runs.push_back(end - i);
    i = end;
  }
  return runs;
}

/// Returns a mask as runs: the numbers of outside, hidden and visible pixels, in turn.
Json mask_json(const PixelMask& mask) {
  Json runs = Json::array();
  auto kind = int(MaskPixel::outside);
  for (std::size_t i = 0; i < mask.pixels.size(); kind = (kind + 1) % 3) {
    std::size_t end = i;
    while (end < mask.pixels.size() && int(mask.pixels[end]) == kind) ++end;
    runs.push_back(end - i);
    i = end;
  }
  return runs;
}

std::string data_of(const ReportRun& run, const Execution& execution) {
  PixelMasks masks(run.surfaces, run.visible, execution);
  Json objects = Json::array();
  for (std::uint32_t i = 0; i < run.accounts.objects.size(); ++i) {
    const ObjectAccount& account = run.accounts.objects[i];
    Json object = object_json(run, i);
    object["name"] = name_of(run, i);
    object["why"] = printable_text(sentence(run.why[i], run.names));
    Json hiders = Json::array();
    for (const HiddenSamples& pair : run.hiders_of(i)) hiders.push_back(Json::array({pair.hider, pair.count}));
    object["hidden_by"] = std::move(hiders);
    if (account.in_frame.count > 0) object["mask"] = mask_json(masks.of(i));
    objects.push_back(std::move(object));
    stop_if_interrupted();
  }
  std::string text = Json{
      {"width", run.view().width},
      {"height", run.view().height},
      {"objects", std::move(objects)},
      {"map",
       map_json(run)}}.dump();
  // Escapes "<", so that the text cannot end its element.
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

std::string rows_of(const ReportRun& run) {
  std::string text;
  for (const std::uint32_t number : objects_by_sight(run.accounts)) {
    const ObjectAccount& object = run.accounts.objects[number];
    const std::string name = html_text(name_of(run, number));
    text += fmt::format(
        "<tr data-object=\"{0}\"><th scope=\"row\" title=\"{1}\"><button>{1}</button></th><td>{0}</td><td>{2}</td>"
        "<td>{3}</td><td>{4}</td><td>{5:.1f} %</td><td>{6:.1f} %</td><td>{7:.1f} %</td><td>{8}</td><td>{9}</td></tr>\n",
        number, name, grouped(object.visible.count), grouped(object.in_frame.count), grouped(object.alone.count),
        100 * object.visible_share(), 100 * object.hidden_share(), 100 * object.cut_share(), distance_text(object),
        html_text(why_text(run, number)));
  }
  return text;
}

std::string table_of(const ReportRun& run) {
  std::string text = "<div class=\"scroll table\"><table><thead><tr>";
  for (const char* title : {"name", "object", "visible", "in frame", "alone", "visible share", "hidden share",
                            "cut share", "distance", "why"})
    text += fmt::format("<th scope=\"col\"><button>{}</button></th>", title);
  return text + "</tr></thead><tbody>\n" + rows_of(run) + "</tbody></table></div>\n";
}

/// Returns a paragraph about nodes that the file hides, or nothing if there are none.
std::string hidden_by_file(const ReportRun& run) {
  std::string names;
  for (const std::string& name : run.scene().source.hidden) names += (names.empty() ? "" : ", ") + printable_name(name);
  return names.empty() ? "" : "<p>Hidden by the file, and not drawn: " + html_text(names) + "</p>\n";
}

std::string page_of(const ReportRun& run, const std::string& picture, const Execution& execution) {
  const View& view = run.view();
  const std::string model = std::filesystem::path(run.settings.model).filename().string();
  std::string text = html_head(model + ": what is seen", style);
  text += fmt::format(
      "<header><h1>{}</h1><p class=\"lines\">{}</p></header><main>\n"
      "<div class=\"look\"><div><div class=\"stage\"><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"What is "
      "seen\"><canvas id=\"overlay\" width=\"{}\" height=\"{}\"></canvas></div><p><label><input type=\"checkbox\" "
      "id=\"outlines\" checked> outlines of objects</label></p></div><div id=\"panel\" data-empty=\"Choose an object "
      "in the picture, the table or the graph: its mask is shown, its hidden parts in the colours of the objects that "
      "hide them.\"></div></div>\n",
      html_text(model), report_summary(run), picture, view.width, view.height, view.width, view.height);
  const std::string graph = report_graph(run);
  text += "<h2>Objects</h2>" + table_of(run) + hidden_by_file(run);
  if (!graph.empty())
    text +=
        "<h2>Who hides whom</h2><p>An arrow goes from what hides to what it hides; objects that hide each other in a "
        "ring are joined by dashes.</p><div class=\"scroll\">" +
        graph + "</div>\n";
  text += "</main><script type=\"application/json\" id=\"data\">" + data_of(run, execution) + "</script>\n<script>";
  text += report_script();
  return text + "</script>" + html_foot();
}

}  // namespace

void write_report_page(const ReportRun& run, const std::string& path, const Execution& execution) {
  const WritingFiles writing;
  const std::filesystem::path beside = std::filesystem::path(path).parent_path();
  const StagedFolder staged(path == "-"      ? std::filesystem::temp_directory_path().string()
                            : beside.empty() ? "."
                                             : beside.string());
  const std::string picture = staged.path("picture.png");
  save(shade(run.surfaces, run.visible, {.shading = Shading::lit, .background = std::nullopt}, execution), picture, {},
       execution);
  save_text(page_of(run, data_uri(picture), execution), path);
}

}  // namespace frontmost::cli
