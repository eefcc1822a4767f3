// SPDX-License-Identifier: Apache-2.0
// The paper and scale of a sheet, and the places of its views.
//
//    before  anchor  behind   gap   before  anchor  behind
//    |---------+--------|           |-----------+------|        one line of cells, along one axis
//
// A line of cells is as wide as its widest view before the anchor and its widest behind it, both times the scale, plus
// room for annotations, which does not scale. So the largest scale for an area is a division. Next to a title block,
// where it depends on the layout's place, it is found by bisection.
#include <algorithm>
#include <cmath>
#include <optional>

#include "sheets/paper.h"

namespace frontmost {
namespace {

using namespace detail;

struct PaperKind {
  std::string_view name;
  double width, height;  // portrait
};
constexpr PaperKind paper_kinds[] = {
    {"a0", 841, 1189}, {"a1", 594, 841}, {"a2", 420, 594},         {"a3", 297, 420},        {"a4", 210, 297},
    {"a5", 148, 210},  {"a6", 105, 148}, {"letter", 215.9, 279.4}, {"legal", 215.9, 355.6}, {"tabloid", 279.4, 431.8}};

/// Removes `ending` if the text has it. \returns whether it did.
bool take_ending(std::string& text, std::string_view ending) {
  if (text.size() <= ending.size() || text.compare(text.size() - ending.size(), ending.size(), ending) != 0)
    return false;
  text.resize(text.size() - ending.size());
  return true;
}

}  // namespace

Paper named_paper(std::string_view name) {
  std::string rest(name);
  for (char& c : rest) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  const bool landscape = take_ending(rest, "-landscape"), portrait = take_ending(rest, "-portrait");
  for (const PaperKind& kind : paper_kinds) {
    if (kind.name != rest) continue;
    return {landscape ? glm::dvec2(kind.height, kind.width) : glm::dvec2(kind.width, kind.height),
            !landscape && !portrait};
  }
  throw Error(ErrorCode::bad_argument, "'" + std::string(name) +
                                           "' is no paper size: a0 to a6, letter, legal or tabloid, perhaps with "
                                           "-portrait or -landscape");
}

std::string paper_name(const glm::dvec2& size) {
  const double narrow = std::min(size.x, size.y), wide = std::max(size.x, size.y);
  for (const PaperKind& kind : paper_kinds) {
    if (kind.width != narrow || kind.height != wide) continue;
    std::string name(kind.name);
    name[0] = char(name[0] - 'a' + 'A');
    return name;
  }
  return size_text(size);
}

std::string scale_text(double scale) { return scale >= 1 ? number_text(scale) + ":1" : "1:" + number_text(1 / scale); }

double standard_scale(double most) {
  constexpr double slack = 1 + 1e-9;
  for (int decade = 9; decade >= 0; --decade)
    for (const int digit : {5, 2, 1})
      if (const double scale = digit * std::pow(10.0, decade); scale <= most * slack) return scale;
  for (int decade = 0; decade < 10; ++decade)
    for (const int digit : {2, 5, 10})
      if (const double scale = 1 / (digit * std::pow(10.0, decade)); scale <= most * slack) return scale;
  return most;  // beyond all standard scales, but it fits
}

namespace detail {
namespace {

constexpr double longest_side = 1e5;   // millimetres, as in validate(Page)
constexpr double widest_spread = 45;   // largest gap between views of a sheet with more room
constexpr double upright_width = 250;  // millimetres, between A4 and A3
constexpr double slack = 1 + 1e-9;     // tolerance for rounding
constexpr int bisections = 60;         // more than the bits of a double

/// The area for views on a page: a rectangle without the part that is both right of `block` and below it.
struct Area {
  glm::dvec2 page{0}, low{0}, high{0};
  std::optional<glm::dvec2> block;

  [[nodiscard]] glm::dvec2 size() const { return high - low; }
};

Area area_on(const glm::dvec2& page, const SheetOptions& options) {
  if (!options.title_block) return {page, glm::dvec2(options.margin), page - options.margin, {}};
  const DrawingSpace space = drawing_space(page);
  return {page, space.low + options.margin, space.high - options.margin, space.block - options.margin};
}

/// The corner of a layout that fits: centred, or centred above or beside the block, or as far from it as possible.
std::optional<glm::dvec2> corner_in(const Area& area, const SheetLayout& layout, double scale) {
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

/// The largest scale at which corner_in() finds a corner; it finds one at every smaller scale, too.
double largest_scale(const Area& area, const SheetLayout& layout) {
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

/// Spreads the views of a framed sheet over the remaining room, as far as the title block allows.
SheetLayout spread(const SheetLayout& layout, const Area& area, double scale) {
  const glm::dvec2 least = layout.gap(), free = area.size() - layout.with_gap(glm::dvec2(0)).size(scale);
  const glm::dvec2 most = glm::clamp(free / (layout.counts() + 1.0), least, glm::dvec2(widest_spread));
  for (const double share : {1.0, 0.5}) {
    const SheetLayout wider = layout.with_gap(glm::mix(least, most, share));
    if (corner_in(area, wider, scale)) return wider;
  }
  return layout;
}

[[noreturn]] void refuse_scale(const glm::dvec2& size, const Area& area, double scale, double fitting) {
  const auto tenths = [](const glm::dvec2& s) { return fixed_text(s.x, 1) + " x " + fixed_text(s.y, 1); };
  throw Error(ErrorCode::limit_exceeded, "scale",
              "at " + scale_text(scale) + " the drawing takes " + tenths(size) + " mm, and the page has " +
                  tenths(area.size()) + " mm between its margins" + (area.block ? " and beside its title block" : "") +
                  "; " + scale_text(standard_scale(fitting)) + " would fit, or take a larger page" +
                  (area.block ? "" : ", or one that fits the drawing"));
}

[[noreturn]] void refuse_page(const char* field, const std::string& text) {
  throw Error(ErrorCode::limit_exceeded, std::string(field), text);
}

SheetPlan fitted_page(const SheetLayout& layout, double scale, double margin) {
  SheetPlan plan{layout.size(scale) + 2 * margin, scale, layout.anchors(scale, glm::dvec2(margin))};
  if (plan.size.x > longest_side || plan.size.y > longest_side)
    refuse_page("scale", "at " + scale_text(scale) + " the page would be " + size_text(plan.size / 1000.0, 4) +
                             " m; 100 m a side is the limit");
  // A drawing of one point, or an empty one, still needs a page.
  plan.size = glm::max(plan.size, glm::dvec2(1));
  return plan;
}

/// The candidate pages, in order of preference.
std::vector<glm::dvec2> pages_of(const Paper& paper, const SheetOptions& options) {
  std::vector<glm::dvec2> pages = {paper.size};
  if (paper.may_turn) pages.emplace_back(paper.size.y, paper.size.x);
  if (!options.title_block) return pages;
  // ISO 5457: A4 is upright, and all larger pages are landscape.
  if (paper.may_turn && paper.size.x > upright_width) std::swap(pages[0], pages[1]);
  std::erase_if(pages,
                [](const glm::dvec2& page) { return page.x < least_framed_page.x || page.y < least_framed_page.y; });
  if (pages.empty())
    refuse_page("page", size_text(paper.size) + " mm have no room for a frame and its title block, which need " +
                            size_text(least_framed_page));
  return pages;
}

/// The area on the page with the largest drawing, and its largest scale. `taken` maps a largest scale to the scale that
/// will be used; among pages with equal results, the first is taken.
template <class Taken>
std::pair<Area, double> best_area(const std::vector<glm::dvec2>& pages, const SheetLayout& layout,
                                  const SheetOptions& options, const Taken& taken) {
  std::pair<Area, double> best{area_on(pages[0], options), 0};
  for (const glm::dvec2& page : pages) {
    const Area area = area_on(page, options);
    if (!(area.size().x > 0 && area.size().y > 0)) continue;
    const double scale = largest_scale(area, layout);
    if (scale > 0 && (best.second == 0 || taken(scale) > taken(best.second))) best = {area, scale};
  }
  return best;
}

/// The smallest of A4 to A0 that has room at the given scale, or A0.
Paper smallest_paper(const SheetLayout& layout, const SheetOptions& options) {
  Paper paper;
  for (const char* const name : {"a4", "a3", "a2", "a1", "a0"}) {
    paper = named_paper(name);
    const auto as_it_is = [](double scale) { return scale; };
    if (best_area(pages_of(paper, options), layout, options, as_it_is).second * slack >= *options.scale) break;
  }
  return paper;
}

Paper paper_of(const SheetLayout& layout, const SheetOptions& options) {
  if (options.page) return *options.page;
  if (options.scale && options.title_block) return smallest_paper(layout, options);
  return {{210, 297}, true, options.scale.has_value()};
}

}  // namespace

glm::ivec2 cell_of(NamedView view, ProjectionMethod method) {
  // Third-angle: the view from a side is placed on that side. First-angle: on the opposite side.
  const int side = method == ProjectionMethod::third_angle ? 1 : -1;
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

std::vector<SheetLayout::Line> SheetLayout::lines_of(const std::vector<ViewCell>& cells, int axis) {
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

SheetLayout::SheetLayout(const std::vector<ViewCell>& cells, const glm::dvec2& gap) : cells_(cells), gap_(gap) {
  for (int axis = 0; axis < 2; ++axis) {
    lines_[axis] = lines_of(cells, axis);
    gaps_[axis] = gap[axis] * double(lines_[axis].size() - 1);
    for (const Line& line : lines_[axis]) {
      extent_[axis] += line.before + line.behind;
      gaps_[axis] += line.room_before + line.room_behind;
    }
  }
}

double SheetLayout::largest_scale(const glm::dvec2& area) const {
  double scale = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis)
    if (extent_[axis] > 0) scale = std::min(scale, (area[axis] - gaps_[axis]) / extent_[axis]);
  return scale < std::numeric_limits<double>::infinity() ? std::max(scale, 0.0) : 1;
}

double SheetLayout::place(const ViewCell& cell, int axis, double scale) const {
  double at = 0;
  for (const Line& line : lines_[axis]) {
    at += line.room_before + line.before * scale;
    if (line.number == (axis == 0 ? cell.column : cell.row)) return at;
    at += line.behind * scale + line.room_behind + gap_[axis];
  }
  return at;
}

std::vector<glm::dvec2> SheetLayout::anchors(double scale, const glm::dvec2& corner) const {
  std::vector<glm::dvec2> anchors;
  for (const ViewCell& cell : cells_)
    anchors.push_back(corner + glm::dvec2(place(cell, 0, scale), place(cell, 1, scale)));
  return anchors;
}

bool SheetLayout::leaves_free(const glm::dvec2& block, double scale, const glm::dvec2& corner) const {
  const std::vector<glm::dvec2> places = anchors(scale, corner);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const glm::dvec2 end = places[i] + cells_[i].high * scale + cells_[i].room_behind;
    if (end.x > block.x && end.y > block.y) return false;
  }
  return true;
}

SheetPlan plan_sheet(const SheetLayout& layout, const SheetOptions& options, bool has_scale) {
  const bool is_sheet = !options.views.empty() || !options.sections.empty();
  const bool is_standard = !options.scale && has_scale && options.standard_scale.value_or(is_sheet);
  const Paper paper = paper_of(layout, options);
  if (paper.fits_drawing) return fitted_page(layout, *options.scale, options.margin);
  const auto taken = [&](double scale) {
    if (!options.title_block) return scale;  // without a title block, the page turns to the better fit
    if (options.scale) return std::min(scale * slack, *options.scale);
    return is_standard ? standard_scale(scale) : scale;
  };
  const auto [area, most] = best_area(pages_of(paper, options), layout, options, taken);
  if (!(area.size().x > 0 && area.size().y > 0))
    refuse_page("margin", number_text(options.margin) + " mm at each side leave nothing of a page of " +
                              size_text(paper.size) + " mm");
  if (!(most > 0))
    refuse_page("page", size_text(paper.size) + " mm have no room for so many views, which stand 15 mm apart");
  if (options.scale && *options.scale > most * slack)
    refuse_scale(layout.size(*options.scale), area, *options.scale, most);
  const double scale = options.scale ? *options.scale : is_standard ? standard_scale(most) : most;
  const SheetLayout placed = area.block ? spread(layout, area, scale) : layout;
  const glm::dvec2 corner = corner_in(area, placed, scale).value_or(area.low);
  return {area.page, scale, placed.anchors(scale, corner)};
}

}  // namespace detail
}  // namespace frontmost
