// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/sizes.h"

#include <frontmost/title_block.h>

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

constexpr double inch = 25.4;   // millimetres
constexpr double page_rim = 5;  // in which printers do not print

std::vector<DimensionedView> dimensioned_views(const std::vector<DrawnView>& views) {
  std::vector<DimensionedView> all;
  for (const DrawnView& drawn : views) {
    DimensionedView& view = all.emplace_back();
    view.sheet = &drawn.sheet;
    view.drawing = &drawn.drawing;
    view.rounds = drawn.rounds.get();
    view.with_hidden = drawn.shows_hidden;
    // Nothing is seen in its true length at an angle, and what is cut is not all of the model.
    view.is_dimensioned = drawn.named != NamedView::iso && !drawn.cut;
    view.taken = drawn.taken;
  }
  return all;
}

}  // namespace

void check_dimensions(const DrawingSettings& settings) {
  if (settings.dimensions && settings.views.empty()) throw UsageError("--dimensions needs --views");
}

void keep_room(std::vector<ViewCell>& cells, const std::vector<DrawnView>& views, const Settings& settings) {
  if (!settings.drawing.dimensions) return;
  const std::vector<OverallSizes> sizes = overall_sizes_of(dimensioned_views(views));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const glm::dvec2 room = room_for(sizes[i], DimensionOptions().text_height);
    if (room.x > 0) cells[i].room_before.x = std::max(cells[i].room_before.x, views[i].taken.x + room.x);
    if (room.y > 0) cells[i].room_behind.y = std::max(cells[i].room_behind.y, views[i].taken.y + room.y);
  }
}

std::size_t add_dimensions(Page& page, const std::vector<DrawnView>& views, const std::vector<PageBox>& marks,
                           const Settings& settings) {
  if (!settings.drawing.dimensions) return 0;
  const bool is_inch = settings.drawing.unit == DrawingSettings::Unit::inch;
  DimensionOptions options;
  options.numbers_per_unit = views.front().millimetres_per_unit / (is_inch ? inch : 1);
  options.decimals = is_inch ? 3 : 2;
  const glm::dvec2 size(page.width, page.height);
  PageBox area{glm::dvec2(page_rim), size - page_rim};
  std::vector<PageBox> taken = marks;
  if (settings.drawing.has_frame()) {
    const DrawingSpace space = drawing_space(size);
    area = {space.low, space.high};
    taken.push_back({space.block, space.high});
  }
  Dimensions all = place_dimensions(dimensioned_views(views), area, taken, options);
  if (all.count > 0) page.layers.push_back(std::move(all.layer));
  return all.left_out;
}

}  // namespace frontmost::cli
