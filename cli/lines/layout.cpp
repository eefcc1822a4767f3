// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/layout.h"

#include <fmt/format.h>
#include <frontmost/title_block.h>

#include <algorithm>
#include <optional>

#include "cli/failure.h"
#include "cli/lines/paper.h"

namespace frontmost::cli {

glm::ivec2 cell_of(NamedView view, DrawingSettings::Layout layout) {
  // Third-angle: what is seen from a side stands on that side. First-angle: on the other one.
  const int side = layout == DrawingSettings::Layout::third_angle ? 1 : -1;
  switch (view) {
    case NamedView::front: return {0, 0};
    case NamedView::left: return {-side, 0};
    case NamedView::right: return {side, 0};
    case NamedView::top: return {0, -side};
    case NamedView::bottom: return {0, side};
    case NamedView::back: return {2, 0};
    case NamedView::iso:
    case NamedView::three_quarter: return {1, -side};
  }
  return {0, 0};
}

std::vector<Layout::Line> Layout::lines_of(const std::vector<ViewCell>& cells, int axis) {
  std::vector<Line> lines;
  for (const ViewCell& cell : cells) {
    const int number = axis == 0 ? cell.column : cell.row;
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.number == number; });
    if (line == lines.end()) line = lines.insert(line, {number, -cell.low[axis], cell.high[axis]});
    line->before = std::max(line->before, -cell.low[axis]);
    line->behind = std::max(line->behind, cell.high[axis]);
    line->room_before = std::max(line->room_before, cell.room_before[axis]);
    line->room_behind = std::max(line->room_behind, cell.room_behind[axis]);
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
  return lines;
}

Layout::Layout(const std::vector<ViewCell>& cells, const glm::dvec2& gap) : cells_(cells), gap_(gap) {
  for (int axis = 0; axis < 2; ++axis) {
    lines_[axis] = lines_of(cells, axis);
    gaps_[axis] = gap[axis] * double(lines_[axis].size() - 1);
    for (const Line& line : lines_[axis]) {
      extent_[axis] += line.before + line.behind;
      gaps_[axis] += line.room_before + line.room_behind;
    }
  }
}

double Layout::largest_scale(const glm::dvec2& area) const {
  double scale = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis)
    if (extent_[axis] > 0) scale = std::min(scale, (area[axis] - gaps_[axis]) / extent_[axis]);
  return scale < std::numeric_limits<double>::infinity() ? std::max(scale, 0.0) : 1;
}

double Layout::place(const ViewCell& cell, int axis, double scale) const {
  double at = 0;
  for (const Line& line : lines_[axis]) {
    at += line.room_before + line.before * scale;
    if (line.number == (axis == 0 ? cell.column : cell.row)) return at;
    at += line.behind * scale + line.room_behind + gap_[axis];
  }
  return at;
}

std::vector<glm::dvec2> Layout::anchors(double scale, const glm::dvec2& corner) const {
  std::vector<glm::dvec2> anchors;
  for (const ViewCell& cell : cells_)
    anchors.push_back(corner + glm::dvec2(place(cell, 0, scale), place(cell, 1, scale)));
  return anchors;
}

bool Layout::leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const {
  const std::vector<glm::dvec2> places = anchors(scale, corner);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const glm::dvec2 end = places[i] + cells_[i].high * scale + cells_[i].room_behind;
    if (end.x > block.x && end.y > block.y) return false;
  }
  return true;
}

namespace {

constexpr double longest_side = 1e5;   // millimetres: validate(Page)
constexpr double widest_spread = 45;   // between views of a sheet that has room
constexpr double upright_width = 250;  // millimetres, between A4 and A3
constexpr double slack = 1 + 1e-9;     // for rounding
constexpr int bisections = 60;         // more than doubles have

/// Where views may stand on a page: from corner to corner, but not both to the right of `block` and below it.
struct Area {
  glm::dvec2 page{0}, low{0}, high{0};
  std::optional<glm::dvec2> block;

  [[nodiscard]] glm::dvec2 size() const { return high - low; }
};

Area area_on(const glm::dvec2& page, const DrawingSettings& settings) {
  if (!settings.has_frame()) return {page, glm::dvec2(settings.margin), page - settings.margin, {}};
  const DrawingSpace space = drawing_space(page);
  return {page, space.low + settings.margin, space.high - settings.margin, space.block - settings.margin};
}

/// The corner of a layout that has room in the area: in its middle, or in that of what is above the block or beside it,
/// or as far from the block as can be.
std::optional<glm::dvec2> corner_in(const Area& area, const Layout& layout, double scale) {
  const glm::dvec2 size = layout.size(scale);
  const auto middle_of = [&](const glm::dvec2& high) { return area.low + (high - area.low - size) * 0.5; };
  const auto fits = [&](const glm::dvec2& high) {
    return glm::all(glm::lessThanEqual(size, (high - area.low) * slack));
  };
  if (!fits(area.high)) return std::nullopt;
  if (!area.block || layout.leaves_free(*area.block, scale, middle_of(area.high))) return middle_of(area.high);
  for (const glm::dvec2 high : {glm::dvec2(area.high.x, area.block->y), glm::dvec2(area.block->x, area.high.y)})
    if (fits(high)) return middle_of(high);
  if (layout.leaves_free(*area.block, scale, area.low)) return area.low;
  return std::nullopt;
}

/// The largest scale that has such a corner. All smaller ones have one too.
double largest_scale(const Area& area, const Layout& layout) {
  double most = layout.largest_scale(area.size());
  if (!area.block || corner_in(area, layout, most)) return most;
  double least = std::max(layout.largest_scale({area.size().x, area.block->y - area.low.y}),
                          layout.largest_scale({area.block->x - area.low.x, area.size().y}));
  for (int i = 0; i < bisections; ++i) {
    const double scale = (least + most) / 2;
    (corner_in(area, layout, scale) ? least : most) = scale;
  }
  return least;
}

/// The views of a sheet with a frame share what room there is, where the title block lets them.
Layout spread(const Layout& layout, const Area& area, double scale) {
  const glm::dvec2 least = layout.gap(), free = area.size() - layout.with_gap(glm::dvec2(0)).size(scale);
  const glm::dvec2 most = glm::clamp(free / (layout.counts() + 1.0), least, glm::dvec2(widest_spread));
  for (const double share : {1.0, 0.5}) {
    const Layout wider = layout.with_gap(glm::mix(least, most, share));
    if (corner_in(area, wider, scale)) return wider;
  }
  return layout;
}

[[noreturn]] void refuse(const glm::dvec2& size, const Area& area, double scale, double fitting) {
  const glm::dvec2 room = area.size();
  throw UsageError(
      fmt::format("--scale: at {} the drawing takes {:.1f} x {:.1f} mm, and the page has {:.1f} x {:.1f} mm "
                  "between its margins{}; --scale {} would fit, or take a larger --page{}",
                  scale_text(scale), size.x, size.y, room.x, room.y, area.block ? " and beside its title block" : "",
                  scale_text(standard_scale(fitting)), area.block ? "" : ", or --page fit"));
}

SheetPlan fitted_page(const Layout& layout, double scale, double margin) {
  SheetPlan plan{layout.size(scale) + 2 * margin, scale, layout.anchors(scale, glm::dvec2(margin))};
  if (plan.size.x > longest_side || plan.size.y > longest_side)
    throw UsageError(fmt::format("--scale: at {} the page would be {:.4g} x {:.4g} m; 100 m a side is the limit",
                                 scale_text(scale), plan.size.x / 1000, plan.size.y / 1000));
  // A drawing of one point, or none.
  plan.size = glm::max(plan.size, glm::dvec2(1));
  return plan;
}

/// The pages that may be taken, in the order of preference.
std::vector<glm::dvec2> pages_of(const PaperSettings& paper, const DrawingSettings& settings) {
  std::vector<glm::dvec2> pages = {paper.size};
  if (paper.may_turn) pages.emplace_back(paper.size.y, paper.size.x);
  if (!settings.has_frame()) return pages;
  // ISO 5457: A4 stands upright, all larger ones lie.
  if (paper.may_turn && paper.size.x > upright_width) std::swap(pages[0], pages[1]);
  const auto is_small = [](const glm::dvec2& page) {
    return page.x < least_framed_page.x || page.y < least_framed_page.y;
  };
  pages.erase(std::remove_if(pages.begin(), pages.end(), is_small), pages.end());
  if (pages.empty())
    throw UsageError(fmt::format("--page: {} x {} mm have no room for a frame and its title block, which need {} x {}",
                                 paper.size.x, paper.size.y, least_framed_page.x, least_framed_page.y));
  return pages;
}

/// The area on that page on which the drawing is largest, and its largest scale there. `taken` is the scale that would
/// be taken of a largest one: of pages on which it is the same the first is best.
template <class Taken>
std::pair<Area, double> best_area(const std::vector<glm::dvec2>& pages, const Layout& layout,
                                  const DrawingSettings& settings, const Taken& taken) {
  std::pair<Area, double> best{area_on(pages[0], settings), 0};
  for (const glm::dvec2& page : pages) {
    const Area area = area_on(page, settings);
    if (!(area.size().x > 0 && area.size().y > 0)) continue;
    const double scale = largest_scale(area, layout);
    if (scale > 0 && (best.second == 0 || taken(scale) > taken(best.second))) best = {area, scale};
  }
  return best;
}

/// Of a scale of numbers: the smallest of A4 to A0 that has room, or A0.
PaperSettings smallest_paper(const Layout& layout, const DrawingSettings& settings) {
  PaperSettings paper;
  for (const char* const name : {"a4", "a3", "a2", "a1", "a0"}) {
    paper = parse_paper(name);
    const auto as_it_is = [](double scale) { return scale; };
    if (best_area(pages_of(paper, settings), layout, settings, as_it_is).second * slack >= settings.scale) break;
  }
  return paper;
}

PaperSettings paper_of(const Layout& layout, const DrawingSettings& settings, ScaleRule rule) {
  if (settings.paper) return *settings.paper;
  const bool is_given = rule == ScaleRule::given;
  if (is_given && settings.has_frame()) return smallest_paper(layout, settings);
  return {{210, 297}, true, is_given};
}

}  // namespace

SheetPlan plan_sheet(const Layout& layout, const DrawingSettings& settings, bool has_scale) {
  const double margin = settings.margin;
  const ScaleRule rule = settings.scale_rule.value_or(settings.is_sheet() ? ScaleRule::standard : ScaleRule::fit);
  const PaperSettings paper = paper_of(layout, settings, rule);
  if (paper.fits_drawing) return fitted_page(layout, settings.scale, margin);
  const auto taken = [&](double scale) {
    if (!settings.has_frame()) return scale;  // without one the page turns to what fits better
    if (rule == ScaleRule::given) return std::min(scale * slack, settings.scale);
    return rule == ScaleRule::standard && has_scale ? standard_scale(scale) : scale;
  };
  const auto [area, most] = best_area(pages_of(paper, settings), layout, settings, taken);
  if (!(area.size().x > 0 && area.size().y > 0))
    throw UsageError(fmt::format("--margin: {} mm at each side leave nothing of a page of {} x {} mm", margin,
                                 paper.size.x, paper.size.y));
  if (!(most > 0))
    throw UsageError(fmt::format("--page: {} x {} mm have no room for so many views, which stand 15 mm apart",
                                 paper.size.x, paper.size.y));
  double scale = rule == ScaleRule::standard && has_scale ? standard_scale(most) : most;
  if (rule == ScaleRule::given) {
    scale = settings.scale;
    if (scale > most * slack) refuse(layout.size(scale), area, scale, most);
  }
  const Layout placed = area.block ? spread(layout, area, scale) : layout;
  const glm::dvec2 corner = corner_in(area, placed, scale).value_or(area.low);
  return {area.page, scale, placed.anchors(scale, corner)};
}

}  // namespace frontmost::cli
