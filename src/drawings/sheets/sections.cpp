// SPDX-License-Identifier: Apache-2.0
// The first view or other section that sees the plane of a section edge-on gets its cutting line.
//
//    A               A          A cutting line is thin, with long dashes and dots, and has thick ends beyond the cut
//    |               |          part. Arrows at the ends point in the section's view direction, with its letter behind
//    v               v          them.
//    ===- - - . - ===
#include <algorithm>
#include <array>
#include <cmath>

#include "rounds/found_rounds.h"
#include "sheets/planned_view.h"

namespace frontmost::detail {
namespace {

constexpr double least_spacing = 1.2, most_spacing = 3;  // millimetres between hatch lines
constexpr double spacing_share = 0.03;                   // as a share of the section's diagonal
constexpr double thinnest = 0.8;                         // millimetres: thinner parts are solid
constexpr double name_distance = 5, name_height = 5;     // millimetres above a section
constexpr int first_own_column = 3;                      // to the right of all named views

[[noreturn]] void refuse_section(const SectionView& wanted, const std::string& reason) {
  throw Error(ErrorCode::bad_argument,
              "sections " + std::string(view_name(wanted.direction)) + (wanted.at ? "=" + number_text(*wanted.at) : ""),
              reason);
}

/// For each section, the index of the view that marks its cutting plane: the first view, or other section, that sees
/// the plane edge-on; the number of views if there is none.
std::vector<std::size_t> hosts_of(const std::vector<PlannedView>& views) {
  std::vector<std::size_t> hosts(views.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].section) continue;
    const auto sees_edge = [&](const PlannedView& view) {
      return std::abs(glm::dot(view.drawing.view.forward(), views[i].drawing.view.forward())) < 1e-6;
    };
    hosts[i] = std::size_t(std::find_if(views.begin(), views.end(), sees_edge) - views.begin());
  }
  return hosts;
}

/// A cutting line in the pixels of its host view.
struct Trace {
  glm::dvec2 from{0}, to{0}, looking{0};
  DrawingBounds box;
};

Trace trace_in(const PlannedView& host, const PlannedView& section) {
  const View& camera = host.drawing.view;
  const glm::dvec3 forward = section.drawing.view.forward();
  Trace trace;
  trace.looking = glm::round(glm::dvec2(glm::dot(forward, camera.right()), -glm::dot(forward, camera.up())));
  trace.box = bounds_of(host.drawing, host.shows_hidden);
  glm::dvec3 point(0);
  point[int(section.plane.towards) % 3] = float(section.plane.at);
  const glm::dvec2 on = on_screen(camera, point);
  const int across = trace.looking.x != 0 ? 0 : 1;
  trace.from = trace.box.low;
  trace.to = trace.box.high;
  trace.from[across] = trace.to[across] = on[across];
  return trace;
}

bool is_empty(const Trace& trace) { return trace.box.is_empty() || !(glm::distance(trace.from, trace.to) > 0); }

constexpr double gap_before = 3, thick_length = 6;   // millimetres beyond the cut part
constexpr double arrow_place = 6;                    // millimetres beyond the cut part: the middle of the thick end
constexpr double arrow_length = 8, head_length = 4;  // millimetres
constexpr double letter_distance = 1;                // millimetres from the arrow's tail

constexpr double along_plane = 0.05;    // the sine of the greatest angle between an axis and a plane along it
constexpr double least_shaft = 2;       // length of a shaft, as a multiple of its diameter
constexpr double around_shaft = 1.001;  // how far a shaft may reach out of its thickest cylinder
constexpr double whole_turn = 6.2;      // radians

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

/// Whether one of the words, or its plural, stands in the text between characters that are no letters.
bool has_word(const std::string& text, std::span<const std::string> words) {
  std::string word;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? lower(text[i]) : ' ';
    if (c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    const auto is_same = [&](std::string wanted) {
      std::transform(wanted.begin(), wanted.end(), wanted.begin(), lower);
      return !wanted.empty() && (word == wanted || word == wanted + "s");
    };
    if (std::any_of(words.begin(), words.end(), is_same)) return true;
    word.clear();
  }
  return false;
}

/// Whether all of an object lies in the cylinder, prolonged at both ends, and is long enough for a shaft.
bool fits_shaft(const Surfaces& surfaces, std::uint32_t instance, const Round& cylinder) {
  if (cylinder.turn < whole_turn) return false;
  const std::uint32_t count =
      std::uint32_t(surfaces.scene().meshes[surfaces.scene().instances[instance].mesh].triangles.size());
  double low = 0, high = 0;
  for (PrimitiveId id = surfaces.first_primitive(instance); id < surfaces.first_primitive(instance) + count; ++id)
    for (const glm::vec3& corner : surfaces.corners(id)) {
      const glm::dvec3 out = glm::dvec3(corner) - cylinder.from;
      const double along = glm::dot(out, cylinder.axis);
      if (!(glm::length(out - along * cylinder.axis) <= around_shaft * cylinder.radius)) return false;
      low = std::min(low, along);
      high = std::max(high, along);
    }
  return high - low >= least_shaft * 2 * cylinder.radius;
}

}  // namespace

std::shared_ptr<const Surfaces> surfaces_of(std::shared_ptr<const Scene> scene, const Execution& execution) {
  struct Owner {
    std::shared_ptr<const Scene> scene;
    Surfaces surfaces;
  };
  const std::shared_ptr<const Owner> owner(new Owner{scene, Surfaces(*scene, execution)});
  return {owner, &owner->surfaces};
}

std::vector<UncutObject> uncut_objects(const Surfaces& surfaces, std::span<const std::string> words,
                                       const Execution& execution) {
  std::vector<UncutObject> uncut;
  if (words.empty()) return uncut;
  const Scene& scene = surfaces.scene();
  const Rounds rounds = find_rounds(surfaces, execution);
  struct Cylinders {
    const Round* thickest = nullptr;
    bool has_bore = false;
  };
  std::vector<Cylinders> cylinders(scene.instances.size());
  for (const Round& round : rounds.rounds) {
    if (round.kind != RoundKind::cylinder || round.count == 0) continue;
    Cylinders& own = cylinders[surfaces.source(rounds.triangles[round.first]).instance];
    own.has_bore |= round.is_hollow;
    if (!round.is_hollow && (own.thickest == nullptr || round.radius > own.thickest->radius)) own.thickest = &round;
  }
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Round* const thickest = cylinders[i].thickest;
    const bool is_shaft = thickest != nullptr && !cylinders[i].has_bore && fits_shaft(surfaces, i, *thickest);
    if (!is_shaft && !has_word(scene.instances[i].name, words)) continue;
    uncut.push_back({i, thickest != nullptr ? std::optional(thickest->axis) : std::nullopt});
  }
  return uncut;
}

void cut_surfaces(PlannedView& view, const SectionView& wanted, std::span<const UncutObject> uncut, const View& camera,
                  const Execution& execution) {
  const glm::dvec3 towards = -camera.forward();
  int axis = 0;  // the one that is nearest to this direction
  for (int k = 1; k < 3; ++k)
    if (std::abs(towards[k]) > std::abs(towards[axis])) axis = k;
  view.plane.towards = Axis(towards[axis] > 0 ? axis : axis + 3);
  const Box& box = view.surfaces->bounds();
  const double origin = view.surfaces->scene().origin[axis], low = box.low[axis], high = box.high[axis];
  view.plane.at = wanted.at ? *wanted.at - origin : (low + high) / 2;
  std::vector<std::uint32_t> whole;
  for (const UncutObject& object : uncut)
    if (!object.axis || std::abs((*object.axis)[axis]) < along_plane) whole.push_back(object.instance);
  view.section = std::make_shared<const Section>(cut(*view.surfaces, view.plane, execution, whole));
  if (view.section->faces.empty() && !whole.empty())
    view.section = std::make_shared<const Section>(cut(*view.surfaces, view.plane, execution));
  if (view.section->faces.empty()) {
    if (!(low <= high)) refuse_section(wanted, "the model has no surface to cut");
    refuse_section(wanted, "the plane misses the model, which lies from " + std::string(1, "xyz"[axis]) + " = " +
                               number_text(low + origin) + " to " + number_text(high + origin));
  }
  view.surfaces = surfaces_of({view.section, &view.section->scene}, execution);
}

void place_sections(std::vector<ViewCell>& cells, const std::vector<PlannedView>& views) {
  int next = first_own_column;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].section) continue;
    for (std::size_t k = 0; k < views.size(); ++k) {
      if (k == i || (views[k].section && k > i)) continue;
      if (cells[k].column != cells[i].column || cells[k].row != cells[i].row) continue;
      cells[i].column = next++;
      cells[i].row = 0;
      break;
    }
  }
}

void keep_section_room(std::vector<ViewCell>& cells, std::vector<PlannedView>& views) {
  const std::vector<std::size_t> hosts = hosts_of(views);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].section) continue;
    cells[i].room_before.y = std::max(cells[i].room_before.y, name_distance + name_height);
    if (hosts[i] == views.size()) continue;
    PlannedView& host = views[hosts[i]];
    ViewCell& cell = cells[hosts[i]];
    const Trace trace = trace_in(host, views[i]);
    if (is_empty(trace)) continue;
    const int across = trace.looking.x != 0 ? 0 : 1, along = 1 - across;
    cell.room_before[along] = std::max(
        cell.room_before[along], cutting_line_room + (along == 1 && host.section ? name_distance + name_height : 0));
    cell.room_behind[along] = std::max(cell.room_behind[along], cutting_line_room);
    // Arrows are on the side from which the section is viewed.
    const bool is_behind = trace.looking[across] < 0;
    const double size = trace.box.high[across] - trace.box.low[across];
    const double rest =
        is_behind ? trace.box.high[across] - trace.from[across] : trace.from[across] - trace.box.low[across];
    const bool reaches_out = rest < size / 4;
    double& side = is_behind ? cell.room_behind[across] : cell.room_before[across];
    if (reaches_out) side = std::max(side, section_arrow_room);
    host.taken[along] = std::max(host.taken[along], cutting_line_room);
    const bool is_left_or_below = is_behind == (across == 1);
    if (reaches_out && is_left_or_below) host.taken[across] = std::max(host.taken[across], section_arrow_room);
  }
}

void hatch_sections(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution) {
  std::vector<const Section*> sections;
  for (const PlannedView& view : views)
    if (view.section) sections.push_back(view.section.get());
  if (sections.empty()) return;
  const std::vector<std::uint8_t> styles = hatch_styles(sections);
  double spacing = least_spacing;
  for (const PlannedView& view : views) {
    const DrawingBounds box = bounds_of(view.drawing, false);
    if (!view.section || box.is_empty()) continue;
    spacing = std::max(spacing, spacing_share * glm::distance(box.low, box.high) * view.placed.millimetres_per_pixel);
  }
  spacing = std::min(spacing, most_spacing);
  const double pen = LinePens().hatching.width * options.pen.value_or(LinePens().seen.width) / LinePens().seen.width;
  for (PlannedView& view : views) {
    if (!view.section) continue;
    const double millimetres = view.placed.millimetres_per_pixel;
    const View& camera = view.drawing.view;
    const double pixel = (camera.projection.right - camera.projection.left) / camera.width;
    const SectionHatching lines{std::clamp(spacing / millimetres, 2.0, 5e4),
                                std::clamp(0.8 * pen / millimetres, 0.5, 1e5), thinnest / millimetres * pixel};
    const HatchOptions hatching{section_hatch_sets(*view.section, styles, lines), section_tone(view.plane), 0,
                                !options.plot, options.plot};
    view.placed.hatching = hatch(*view.surfaces, camera, hatching, execution);
  }
}

SectionMarks draw_section_marks(std::span<const CuttingLine> lines, std::span<const ViewName> names,
                                const SectionMarkOptions& options) {
  if (!(options.text_height >= 0.5 && options.text_height <= 100))
    throw Error(ErrorCode::bad_argument, "text_height", "must be from 0.5 to 100 millimetres");
  const Pen& pen = options.thin;
  const double height = options.text_height;
  PageGroup thin{"", pen}, thick{"", {2 * pen.width, pen.color}}, heads{"", {pen.width, pen.color}};
  PageGroup texts{"", text_pen(height)};
  texts.pen.color = pen.color;
  SectionMarks marks;
  const auto draw_end = [&](const CuttingLine& line, const glm::dvec2& end, const glm::dvec2& outwards) {
    const glm::dvec2 thick_end[] = {end + gap_before * outwards, end + (gap_before + thick_length) * outwards};
    thick.add(thick_end, false);
    const glm::dvec2 tip = end + arrow_place * outwards, tail = tip - arrow_length * line.looking;
    heads.add(std::array{tail, tip}, false);
    add_arrowhead(heads, tip, line.looking, head_length);
    const double half = height / 2;
    const glm::dvec2 letter = tail - (letter_distance + half) * line.looking;
    add_text(texts, line.letter, letter, {height, 0, TextAlign::centre, TextLine::middle}, options.lettering);
    PageBox box{letter - half, letter + half};
    for (const glm::dvec2& corner : {thick_end[0], thick_end[1], tail}) {
      box.low = glm::min(box.low, corner);
      box.high = glm::max(box.high, corner);
    }
    marks.boxes.push_back(box);
  };
  for (const CuttingLine& line : lines) {
    if (!(glm::distance(line.from, line.to) > 0)) throw Error(ErrorCode::bad_argument, "a cutting line has no length");
    const glm::dvec2 along = glm::normalize(line.to - line.from);
    thin.add(std::array{line.from - gap_before * along, line.to + gap_before * along}, false);
    draw_end(line, line.from, -along);
    draw_end(line, line.to, along);
  }
  for (const ViewName& name : names) {
    add_text(texts, name.text, name.at, {height, 0, TextAlign::centre, TextLine::bottom}, options.lettering);
    const double half = text_width(name.text, height) / 2;
    marks.boxes.push_back({name.at - glm::dvec2(half, height), name.at + glm::dvec2(half, 0)});
  }
  for (PageGroup* const group : {&thin, &thick, &heads, &texts})
    if (!group->is_empty()) marks.layer.groups.push_back(std::move(*group));
  return marks;
}

SectionMarks section_marks_of(const std::vector<PlannedView>& views, const Pen& thin, Lettering lettering) {
  const std::vector<std::size_t> hosts = hosts_of(views);
  std::vector<CuttingLine> lines;
  std::vector<ViewName> names;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const DrawingBounds box = bounds_of(views[i].drawing, false);
    if (!views[i].section || box.is_empty()) continue;  // the near and far planes may leave nothing of a section
    const glm::dvec2 low = views[i].placed.on_page(box.low), high = views[i].placed.on_page(box.high);
    bool is_host = false;
    for (std::size_t k = 0; k < hosts.size(); ++k) is_host = is_host || (views[k].section && hosts[k] == i);
    const double above = name_distance + (is_host ? cutting_line_room : 0);
    names.push_back({{(low.x + high.x) / 2, low.y - above}, views[i].name});
    if (hosts[i] == views.size()) continue;
    const PlannedView& host = views[hosts[i]];
    const Trace trace = trace_in(host, views[i]);
    if (is_empty(trace)) continue;
    lines.push_back({host.placed.on_page(trace.from), host.placed.on_page(trace.to), trace.looking, views[i].letter});
  }
  return draw_section_marks(lines, names, {thin, name_height, lettering});
}

}  // namespace frontmost::detail
