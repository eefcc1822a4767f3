// SPDX-License-Identifier: Apache-2.0
// The paper and scale of a sheet: the largest scale that fits, or the given one.
//
//    candidate pages in order of preference --> the largest scale on each
//        --> rounded to ISO 5455, or as given --> views spread over the remaining room
//
// Next to a title block, whether a layout fits depends on its place, and the largest scale has no formula. It is found
// by bisection: a layout that fits at a scale fits at every smaller one.
#include <algorithm>
#include <optional>

#include "sheets/frame/title_block.h"
#include "sheets/layout/layout.h"
#include "sheets/page_marks.h"

namespace frontmost::detail {
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

/// The corner of a layout that fits into the area: centred, or centred in the part above or beside the block, or as far
/// from the block as possible.
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

/// The largest scale with such a corner; smaller ones have one too.
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
  throw Error(ErrorCode::limit_exceeded, "scale",
              "at " + scale_text(scale) + " the drawing takes " + tenths_text(size) + " mm, and the page has " +
                  tenths_text(area.size()) + " mm between its margins" +
                  (area.block ? " and beside its title block" : "") + "; " + scale_text(standard_scale(fitting)) +
                  " would fit, or take a larger page" + (area.block ? "" : ", or one that fits the drawing"));
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
  // ISO 5457: A4 is upright, all larger pages lie.
  if (paper.may_turn && paper.size.x > upright_width) std::swap(pages[0], pages[1]);
  const auto is_small = [](const glm::dvec2& page) {
    return page.x < least_framed_page.x || page.y < least_framed_page.y;
  };
  pages.erase(std::remove_if(pages.begin(), pages.end(), is_small), pages.end());
  if (pages.empty())
    refuse_page("page", size_text(paper.size) + " mm have no room for a frame and its title block, which need " +
                            size_text(least_framed_page));
  return pages;
}

/// The area on the page with the largest drawing, and its largest scale. `taken` maps a largest scale to the scale that
/// will be used; the first of the pages with equal results is best.
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

}  // namespace frontmost::detail
