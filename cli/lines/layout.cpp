// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/layout.h"

#include <fmt/format.h>

#include <algorithm>

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
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
  return lines;
}

Layout::Layout(const std::vector<ViewCell>& cells, double gap) : cells_(cells), gap_(gap) {
  for (int axis = 0; axis < 2; ++axis) {
    lines_[axis] = lines_of(cells, axis);
    for (const Line& line : lines_[axis]) extent_[axis] += line.before + line.behind;
    gaps_[axis] = gap * double(lines_[axis].size() - 1);
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
    if (line.number == (axis == 0 ? cell.column : cell.row)) return at + line.before * scale;
    at += (line.before + line.behind) * scale + gap_;
  }
  return at;
}

std::vector<glm::dvec2> Layout::anchors(double scale, const glm::dvec2& corner) const {
  std::vector<glm::dvec2> anchors;
  for (const ViewCell& cell : cells_)
    anchors.push_back(corner + glm::dvec2(place(cell, 0, scale), place(cell, 1, scale)));
  return anchors;
}

namespace {

constexpr double longest_side = 1e5;  // millimetres: validate(Page)

[[noreturn]] void refuse(const glm::dvec2& size, const glm::dvec2& area, double scale, double fitting) {
  const double standard = standard_scale(fitting);
  throw UsageError(
      fmt::format("--scale: at {} the drawing takes {:.1f} x {:.1f} mm, and the page has {:.1f} x {:.1f} mm "
                  "between its margins; --scale {} would fit, or take a larger --page, or --page fit",
                  scale_text(scale), size.x, size.y, area.x, area.y, scale_text(standard)));
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

}  // namespace

SheetPlan plan_sheet(const Layout& layout, const DrawingSettings& settings, bool has_scale) {
  const double margin = settings.margin;
  const ScaleRule rule = settings.scale_rule.value_or(settings.views.empty() ? ScaleRule::fit : ScaleRule::standard);
  const PaperSettings paper = settings.paper.value_or(PaperSettings{{210, 297}, true, rule == ScaleRule::given});
  if (paper.fits_drawing) return fitted_page(layout, settings.scale, margin);
  glm::dvec2 page = paper.size, turned(paper.size.y, paper.size.x);
  double most = layout.largest_scale(page - 2 * margin);
  if (const double other = layout.largest_scale(turned - 2 * margin); paper.may_turn && other > most) {
    most = other;
    page = turned;
  }
  const glm::dvec2 area = page - 2 * margin;
  if (!(area.x > 0 && area.y > 0))
    throw UsageError(fmt::format("--margin: {} mm at each side leave nothing of a page of {} x {} mm", margin,
                                 paper.size.x, paper.size.y));
  if (!(most > 0))
    throw UsageError(fmt::format("--page: {} x {} mm have no room for so many views, which stand 15 mm apart",
                                 paper.size.x, paper.size.y));
  double scale = rule == ScaleRule::standard && has_scale ? standard_scale(most) : most;
  if (rule == ScaleRule::given) {
    scale = settings.scale;
    if (scale > most * (1 + 1e-9)) refuse(layout.size(scale), area, scale, most);
  }
  return {page, scale, layout.anchors(scale, (page - layout.size(scale)) * 0.5)};
}

}  // namespace frontmost::cli
