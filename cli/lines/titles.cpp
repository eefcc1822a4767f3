// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/titles.h"

#include "cli/failure.h"
#include "cli/lines/paper.h"

namespace frontmost::cli {
namespace {

ProjectionMethod method_of(const DrawingSettings& settings) {
  if (!settings.is_sheet()) return ProjectionMethod::none;
  return settings.layout == DrawingSettings::Layout::third_angle ? ProjectionMethod::third_angle
                                                                 : ProjectionMethod::first_angle;
}

}  // namespace

void check_frame(const DrawingSettings& settings) {
  if (settings.has_frame() && settings.paper && settings.paper->fits_drawing)
    throw UsageError("--page fit: a frame needs a page of its own size");
}

void add_frame(Page& page, const Settings& settings, std::optional<double> scale, const std::string& name) {
  const DrawingSettings::TitleTexts& texts = settings.drawing.texts;
  page.title = texts.title.value_or(name);
  TitleBlock block;
  block.title = page.title;
  block.number = texts.number.value_or("");
  block.author = texts.author.value_or("");
  block.date = texts.date.value_or("");
  block.owner = texts.owner.value_or("");
  block.scale = scale ? scale_text(*scale) : "\xE2\x80\x93";  // a dash: in perspective nothing has one
  block.unit = settings.drawing.unit == DrawingSettings::Unit::inch ? "in" : "mm";
  block.paper = paper_text({page.width, page.height});
  block.projection = method_of(settings.drawing);
  block.sheet = settings.drawing.sheet;
  block.sheets = settings.drawing.sheets;
  page.layers.push_back(draw_frame({page.width, page.height}, block));
}

}  // namespace frontmost::cli
