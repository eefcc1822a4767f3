// SPDX-License-Identifier: Apache-2.0
// From the options of a sheet to its page: views, their places, their lines, and annotations.
//
//    options --> views are drawn --> cells --> plan: paper, scale, places
//                                                 --> strokes, hatching, dimensions, frame --> Page
//
// Lines are found before the scale is known, because the drawn lines determine how much room a view takes. Everything
// measured in millimetres of paper comes after the plan: dashes, hatching, numbers.
#include <algorithm>

#include "base/parallel.h"
#include "sheets/dimensions/dimensions.h"
#include "sheets/frame/title_block.h"
#include "sheets/planned_view.h"
#include "sheets/sections/sections.h"

namespace frontmost {
namespace {

using namespace detail;

constexpr double gap_between_views = 15;  // millimetres
constexpr double page_rim = 5;            // millimetres in which printers do not print

std::vector<DimensionedView> dimensioned_views(const std::vector<PlannedView>& views) {
  std::vector<DimensionedView> all;
  for (const PlannedView& planned : views) {
    DimensionedView& view = all.emplace_back();
    view.sheet = &planned.placed;
    view.drawing = &planned.drawing;
    view.rounds = planned.rounds.get();
    view.with_hidden = planned.shows_hidden;
    // A section does not show the size of the whole model.
    view.is_dimensioned = !is_at_an_angle(*planned.direction) && !planned.section;
    view.taken = planned.taken;
  }
  return all;
}

/// Reserves room in the cells for the overall sizes of their views.
void keep_room_for_sizes(std::vector<ViewCell>& cells, const std::vector<PlannedView>& views) {
  const std::vector<OverallSizes> sizes = overall_sizes_of(dimensioned_views(views));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const glm::dvec2 room = room_for(sizes[i], DimensionOptions().text_height);
    if (room.x > 0) cells[i].room_before.x = std::max(cells[i].room_before.x, views[i].taken.x + room.x);
    if (room.y > 0) cells[i].room_behind.y = std::max(cells[i].room_behind.y, views[i].taken.y + room.y);
  }
}

/// Lays out the views and sets their places. \returns the plan.
SheetPlan place_views(std::vector<PlannedView>& views, const Surfaces& surfaces, const SheetOptions& options) {
  Cells all = cells_of(views, surfaces, options);
  place_sections(all.cells, views);
  keep_section_room(all.cells, views);
  if (options.dimensions) keep_room_for_sizes(all.cells, views);
  const bool has_scale = views[0].drawing.view.projection.orthographic;
  SheetPlan plan = plan_sheet(SheetLayout(all.cells, glm::dvec2(gap_between_views)), options, has_scale);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SheetView& placed = views[i].placed;
    placed.millimetres_per_pixel = views[i].millimetres_per_pixel * plan.scale;
    placed.origin = plan.anchors[i] - all.anchors[i] * placed.millimetres_per_pixel;
  }
  return plan;
}

void draw_in_places(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution) {
  for (PlannedView& view : views) place_strokes(view, options, execution);
  report_progress(execution, "tones", 0);
  hatch_sections(views, options, execution);
  for (PlannedView& view : views) {
    place_tones(view, options, execution);
    place_centre_lines(view, options);
  }
}

/// Adds dimensions to the page, clear of its rim or of its later frame and title block, and of `marks`.
void add_dimensions(Sheet& sheet, const std::vector<PlannedView>& views, const std::vector<PageBox>& marks,
                    const Scene& scene, const SheetOptions& options) {
  DimensionOptions numbers;
  const bool in_inches = is_in_inches(options, scene);
  numbers.numbers_per_unit = millimetres_per_unit(options, scene) / (in_inches ? inch : 1);
  numbers.decimals = in_inches ? 3 : 2;
  const glm::dvec2 size(sheet.page.width, sheet.page.height);
  PageBox area{glm::dvec2(page_rim), size - page_rim};
  std::vector<PageBox> taken = marks;
  if (options.title_block) {
    const DrawingSpace space = drawing_space(size);
    area = {space.low, space.high};
    taken.push_back({space.block, space.high});
  }
  Dimensions all = place_dimensions(dimensioned_views(views), area, taken, numbers);
  if (all.count > 0) sheet.page.layers.push_back(std::move(all.layer));
  sheet.left_out = all.left_out;
  sheet.undrawn = all.undrawn;
  sheet.prisms = all.prisms;
}

void add_frame(Page& page, const SheetOptions& options, const Scene& scene, std::optional<double> scale) {
  TitleBlock block = *options.title_block;
  page.title = block.title;
  block.scale = scale ? scale_text(*scale) : "\xE2\x80\x93";  // a dash: views in perspective have no scale
  block.unit = is_in_inches(options, scene) ? "in" : "mm";
  block.paper = paper_name({page.width, page.height});
  block.projection = has_named_views(options) ? options.projection : ProjectionMethod::none;
  page.layers.push_back(draw_frame({page.width, page.height}, block));
}

/// Finishes a sheet from its drawn views.
Sheet finish(std::vector<PlannedView> views, const Surfaces& surfaces, const SheetOptions& options,
             const Execution& execution) {
  report_progress(execution, "rounds", 0);
  find_rounds_of(views, options, execution);
  report_progress(execution, "layout", 0);
  const SheetPlan plan = place_views(views, surfaces, options);
  draw_in_places(views, options, execution);
  report_progress(execution, "page", 0);
  const LinePens pens = pens_of(options);
  std::vector<SheetView> placed;
  for (const PlannedView& view : views) placed.push_back(view.placed);
  Sheet sheet;
  sheet.page = page_of(surfaces, placed, pens, plan.size);
  sheet.is_empty = sheet.page.layers.empty();
  if (views[0].drawing.view.projection.orthographic) sheet.scale = plan.scale;
  SectionMarks marks = section_marks_of(views, pens.centre);
  if (!marks.layer.groups.empty()) sheet.page.layers.push_back(std::move(marks.layer));
  if (options.dimensions) add_dimensions(sheet, views, marks.boxes, surfaces.scene(), options);
  if (options.title_block) add_frame(sheet.page, options, surfaces.scene(), sheet.scale);
  for (PlannedView& view : views) sheet.views.push_back(std::move(view));
  return sheet;
}

}  // namespace

Sheet draw_sheet(const Surfaces& surfaces, const SheetOptions& options, const Execution& execution) {
  validate(options);
  if (!has_named_views(options)) throw Error(ErrorCode::bad_argument, "views", "there is none, nor a section");
  report_progress(execution, "views", 0);
  return finish(draw_named_views(surfaces, options, execution), surfaces, options, execution);
}

Sheet draw_view(const Surfaces& surfaces, const View& view, const SheetOptions& options, const Execution& execution) {
  validate(options);
  validate_for_view(options, view.projection);
  report_progress(execution, "views", 0);
  std::vector<PlannedView> views;
  views.push_back(draw_given_view(surfaces, view, options, execution));
  return finish(std::move(views), surfaces, options, execution);
}

}  // namespace frontmost
