// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/sizes.h"

#include <frontmost/title_block.h>

#include "cli/failure.h"
#include "cli/lines/units.h"

namespace frontmost::cli {
namespace {

constexpr double inch = 25.4;   // millimetres
constexpr double page_rim = 5;  // in which printers do not print

std::vector<DimensionedView> dimensioned_views(const std::vector<DrawnView>& views, const Settings& settings) {
  std::vector<DimensionedView> all;
  for (std::size_t i = 0; i < views.size(); ++i) {
    DimensionedView& view = all.emplace_back();
    view.sheet = &views[i].sheet;
    view.drawing = &views[i].drawing;
    view.rounds = views[i].rounds.get();
    view.with_hidden = views[i].shows_hidden;
    // Nothing is seen in its true length there.
    view.is_dimensioned = settings.drawing.views[i] != NamedView::iso;
  }
  return all;
}

}  // namespace

void check_dimensions(const DrawingSettings& settings) {
  if (settings.dimensions && settings.views.empty()) throw UsageError("--dimensions needs --views");
}

void keep_room(std::vector<ViewCell>& cells, const std::vector<DrawnView>& views, const Settings& settings) {
  if (!settings.drawing.dimensions) return;
  const std::vector<OverallSizes> sizes = overall_sizes(dimensioned_views(views, settings));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const glm::dvec2 room = room_for(sizes[i], DimensionOptions().text_height);
    cells[i].room_before.x = std::max(cells[i].room_before.x, room.x);
    cells[i].room_behind.y = std::max(cells[i].room_behind.y, room.y);
  }
}

std::size_t add_dimensions(Page& page, const std::vector<DrawnView>& views, const Settings& settings) {
  if (!settings.drawing.dimensions) return 0;
  const bool is_inch = settings.drawing.unit == DrawingSettings::Unit::inch;
  DimensionOptions options;
  options.numbers_per_unit = unit_of(settings) / (is_inch ? inch : 1);
  options.decimals = is_inch ? 3 : 2;
  const glm::dvec2 size(page.width, page.height);
  PageBox area{glm::dvec2(page_rim), size - page_rim};
  std::vector<PageBox> taken;
  if (settings.drawing.has_frame()) {
    const DrawingSpace space = drawing_space(size);
    area = {space.low, space.high};
    taken.push_back({space.block, space.high});
  }
  Dimensions all = dimensions(dimensioned_views(views, settings), area, taken, options);
  if (all.count > 0) page.layers.push_back(std::move(all.layer));
  return all.left_out;
}

}  // namespace frontmost::cli
