// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/failure.h"
#include "cli/view_options.h"

namespace frontmost::cli {
namespace {

constexpr std::string_view letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";  // none that looks like a number
constexpr double least_spacing = 1.2, most_spacing = 3;           // millimetres between hatch lines
constexpr double spacing_share = 0.03;                            // of the section's diagonal
constexpr double thinnest = 0.8;                                  // millimetres: parts below it are solid
constexpr double name_distance = 5, name_height = 5;              // millimetres above a section
constexpr int first_own_column = 3;                               // behind those of all views

/// The axis to which a view along one looks from.
Axis axis_towards(const glm::dvec3& direction) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(direction[k]) > std::abs(direction[axis])) axis = k;
  return Axis(direction[axis] > 0 ? axis : axis + 3);
}

/// The view in which each section's plane is marked: the first that sees it from its edge, if need be another section.
std::vector<std::size_t> hosts_of(const std::vector<DrawnView>& views) {
  std::vector<std::size_t> hosts(views.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].cut) continue;
    const auto sees_edge = [&](const DrawnView& view) {
      return std::abs(glm::dot(view.drawing.view.forward(), views[i].drawing.view.forward())) < 1e-6;
    };
    hosts[i] = std::size_t(std::find_if(views.begin(), views.end(), sees_edge) - views.begin());
  }
  return hosts;
}

/// A cutting line in the pixels of its host.
struct Trace {
  glm::dvec2 from{0}, to{0}, looking{0};
  DrawingBounds box;
};

Trace trace_in(const DrawnView& host, const DrawnView& section) {
  const View& camera = host.drawing.view;
  const glm::dvec3 forward = section.drawing.view.forward();
  Trace trace;
  trace.looking = glm::round(glm::dvec2(glm::dot(forward, camera.right()), -glm::dot(forward, camera.up())));
  trace.box = bounds_of(host.drawing, host.shows_hidden);
  glm::dvec3 point(0);
  point[int(section.cut->plane.towards) % 3] = float(section.cut->plane.at);
  const glm::dvec2 on = on_screen(camera, point);
  const int across = trace.looking.x != 0 ? 0 : 1;
  trace.from = trace.box.low;
  trace.to = trace.box.high;
  trace.from[across] = trace.to[across] = on[across];
  return trace;
}

bool is_empty(const Trace& trace) { return trace.box.is_empty() || !(glm::distance(trace.from, trace.to) > 0); }

}  // namespace

void check_sections(const DrawingSettings& settings) {
  if (settings.sections.empty()) return;
  if (settings.style == DrawingSettings::Style::figure) throw UsageError("--sections: figures have none");
  if (settings.hatch || settings.stipple)
    throw UsageError("--sections: hatching says what is cut; leave out --hatch and --stipple");
}

void cut_view(DrawnView& view, const Surfaces& surfaces, const DrawingSettings& settings, std::size_t number,
              const View& camera, const Execution& execution) {
  const DrawingSettings::SectionView& wanted = settings.sections[number];
  CuttingPlane plane;
  plane.towards = axis_towards(-camera.forward());
  const int axis = int(plane.towards) % 3;
  const Box& box = surfaces.bounds();
  const double origin = surfaces.scene().origin[axis], low = box.low[axis], high = box.high[axis];
  plane.at = wanted.at ? *wanted.at - origin : (low + high) / 2;
  auto cut = std::make_unique<CutView>(
      CutView{frontmost::cut(surfaces, plane, execution), plane, std::string(1, letters[number])});
  if (cut->section.faces.empty()) {
    const std::string_view name = view_name(wanted.view);
    const std::string place = wanted.at ? fmt::format("={:.6g}", *wanted.at) : std::string();
    if (!(low <= high)) throw UsageError(fmt::format("--sections {}{}: the model has no surface to cut", name, place));
    throw UsageError(fmt::format("--sections {}{}: the plane misses the model, which lies from {} = {:.6g} to {:.6g}",
                                 name, place, "xyz"[axis], low + origin, high + origin));
  }
  view.own = std::make_unique<const Surfaces>(cut->section.scene, execution);
  view.surfaces = view.own.get();
  view.cut = std::move(cut);
}

std::vector<std::string> open_outlines(const std::vector<DrawnView>& views) {
  std::vector<std::string> warnings;
  for (const DrawnView& view : views) {
    if (!view.cut) continue;
    std::size_t open = 0, objects = 0;
    for (const CutFace& face : view.cut->section.faces) {
      open += face.open_count;
      objects += face.open_count > 0;
    }
    if (open == 0) continue;
    warnings.push_back(
        fmt::format("section {0}-{0}: {1} of the lines that it cuts do not close, on {2} of {3} objects: "
                    "the mesh is open there, and is not hatched",
                    view.cut->letter, open, objects, view.cut->section.faces.size()));
  }
  return warnings;
}

void place_sections(std::vector<ViewCell>& cells, const std::vector<DrawnView>& views) {
  int next = first_own_column;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].cut) continue;
    for (std::size_t k = 0; k < views.size(); ++k) {
      if (k == i || (views[k].cut && k > i)) continue;
      if (cells[k].column != cells[i].column || cells[k].row != cells[i].row) continue;
      cells[i].column = next++;
      cells[i].row = 0;
      break;
    }
  }
}

void keep_section_room(std::vector<ViewCell>& cells, std::vector<DrawnView>& views) {
  const std::vector<std::size_t> hosts = hosts_of(views);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].cut) continue;
    cells[i].room_before.y = std::max(cells[i].room_before.y, name_distance + name_height);
    if (hosts[i] == views.size()) continue;
    DrawnView& host = views[hosts[i]];
    ViewCell& cell = cells[hosts[i]];
    const Trace trace = trace_in(host, views[i]);
    if (is_empty(trace)) continue;
    const int across = trace.looking.x != 0 ? 0 : 1, along = 1 - across;
    cell.room_before[along] = std::max(cell.room_before[along],
                                       cutting_line_room + (along == 1 && host.cut ? name_distance + name_height : 0));
    cell.room_behind[along] = std::max(cell.room_behind[along], cutting_line_room);
    // Arrows stand where the viewer of the section does.
    const bool is_behind = trace.looking[across] < 0;
    const double size = trace.box.high[across] - trace.box.low[across];
    const double rest =
        is_behind ? trace.box.high[across] - trace.from[across] : trace.from[across] - trace.box.low[across];
    const bool reaches_out = rest < size / 4;
    double& side = is_behind ? cell.room_behind[across] : cell.room_before[across];
    if (reaches_out) side = std::max(side, section_arrow_room);
    const bool is_left = along == 0 || (reaches_out && !is_behind), is_below = along == 1 || (reaches_out && is_behind);
    if (is_left) host.taken.x = std::max(host.taken.x, along == 0 ? cutting_line_room : section_arrow_room);
    if (is_below) host.taken.y = std::max(host.taken.y, along == 1 ? cutting_line_room : section_arrow_room);
  }
}

void hatch_sections(std::vector<DrawnView>& views, const Settings& settings, const Execution& execution) {
  std::vector<const Section*> sections;
  for (const DrawnView& view : views)
    if (view.cut) sections.push_back(&view.cut->section);
  if (sections.empty()) return;
  const std::vector<std::uint8_t> styles = hatch_styles(sections);
  double spacing = least_spacing;
  for (const DrawnView& view : views) {
    const DrawingBounds box = bounds_of(view.drawing, false);
    if (!view.cut || box.is_empty()) continue;
    spacing = std::max(spacing, spacing_share * glm::distance(box.low, box.high) * view.sheet.millimetres_per_pixel);
  }
  spacing = std::min(spacing, most_spacing);
  const double pen =
      LinePens().hatching.width * settings.drawing.pen.value_or(LinePens().seen.width) / LinePens().seen.width;
  for (DrawnView& view : views) {
    if (!view.cut) continue;
    const double millimetres = view.sheet.millimetres_per_pixel;
    const View& camera = view.drawing.view;
    SectionHatching options;
    options.spacing = std::clamp(spacing / millimetres, 2.0, 5e4);
    options.solid_spacing = std::clamp(0.8 * pen / millimetres, 0.5, 1e5);
    const double pixel = (camera.projection.right - camera.projection.left) / camera.width;
    options.thinnest = thinnest / millimetres * pixel;
    HatchOptions hatching;
    hatching.sets = section_hatch_sets(view.cut->section, styles, options);
    hatching.tone = section_tone(view.cut->plane);
    hatching.by_instance = !settings.drawing.plot;
    hatching.nearest_first = settings.drawing.plot;
    view.sheet.hatching = hatch(*view.surfaces, camera, hatching, execution);
  }
}

SectionMarks marks_of(const std::vector<DrawnView>& views, const Pen& thin) {
  const std::vector<std::size_t> hosts = hosts_of(views);
  std::vector<CuttingLine> lines;
  std::vector<ViewName> names;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].cut) continue;
    const DrawingBounds box = bounds_of(views[i].drawing, false);
    const glm::dvec2 low = views[i].sheet.on_page(box.low), high = views[i].sheet.on_page(box.high);
    bool is_host = false;
    for (std::size_t k = 0; k < hosts.size(); ++k) is_host = is_host || (views[k].cut && hosts[k] == i);
    const double above = name_distance + (is_host ? cutting_line_room : 0);
    names.push_back({{(low.x + high.x) / 2, low.y - above}, fmt::format("{0}-{0}", views[i].cut->letter)});
    if (hosts[i] == views.size()) continue;
    const DrawnView& host = views[hosts[i]];
    const Trace trace = trace_in(host, views[i]);
    if (is_empty(trace)) continue;
    lines.push_back(
        {host.sheet.on_page(trace.from), host.sheet.on_page(trace.to), trace.looking, views[i].cut->letter});
  }
  SectionMarkOptions options;
  options.thin = thin;
  options.text_height = name_height;
  return draw_section_marks(lines, names, options);
}

}  // namespace frontmost::cli
