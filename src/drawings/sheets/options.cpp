// SPDX-License-Identifier: Apache-2.0
// Options of sheets are validated here; errors name the field.
//
// All options are checked before anything is drawn, and an error says which values are allowed. Later steps only have
// errors that depend on the drawing, such as a plane that misses the model.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sheets/page_marks.h"
#include "sheets/planned_view.h"
#include "sheets/sections/sections.h"

namespace frontmost {

void detail::refuse_option(const std::string& field, const std::string& reason) {
  throw Error(ErrorCode::bad_argument, field, reason);
}

namespace {

using detail::refuse_option;

void check_range(const char* field, std::optional<double> value, double least, double most) {
  // Written so that NaN fails.
  if (value && !(*value >= least && *value <= most))
    refuse_option(field, "must be from " + detail::number_text(least) + " to " + detail::number_text(most));
}

std::string quoted(NamedView view) { return std::string("'").append(view_name(view)).append("'"); }

void check_each_once(const char* field, const std::vector<NamedView>& views) {
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (views[i] == views[k]) refuse_option(field, quoted(views[i]) + " is there twice");
      if (detail::is_at_an_angle(views[i]) && detail::is_at_an_angle(views[k]))
        refuse_option(field, quoted(views[k]) + " and " + quoted(views[i]) + " have one place");
    }
}

void check_named_views(const SheetOptions& o) {
  check_each_once("views", o.views);
  if (!o.hidden_views) return;
  check_each_once("hidden_views", *o.hidden_views);
  if (o.hidden == HiddenLines::none) refuse_option("hidden_views", "needs hidden lines, dashed or thin");
  for (const NamedView view : *o.hidden_views)
    if (std::find(o.views.begin(), o.views.end(), view) == o.views.end())
      refuse_option("hidden_views", std::string(view_name(view)) + " is not among the views");
}

void check_section_views(const SheetOptions& o) {
  if (o.sections.empty()) return;
  if (o.sections.size() > detail::section_letters.size())
    refuse_option("sections", std::to_string(detail::section_letters.size()) + " are the most");
  for (std::size_t i = 0; i < o.sections.size(); ++i) {
    const SectionView& section = o.sections[i];
    if (detail::is_at_an_angle(section.direction))
      refuse_option("sections", quoted(section.direction) + " looks along no axis");
    if (section.at && !std::isfinite(*section.at)) refuse_option("sections", "a plane must be at a finite place");
    for (std::size_t k = 0; k < i; ++k)
      if (section.direction == o.sections[k].direction && section.at == o.sections[k].at)
        refuse_option("sections", quoted(section.direction) + " is there twice at one place");
  }
  if (o.style == DrawingStyle::figure) refuse_option("sections", "figures have none");
  if (o.hatch || o.stipple) refuse_option("sections", "hatching says what is cut; leave out hatch and stipple");
}

void check_paper(const SheetOptions& o) {
  if (!o.page) return;
  if (!o.page->fits_drawing) {
    check_range("page", o.page->size.x, 1, 1e5);
    check_range("page", o.page->size.y, 1, 1e5);
  } else if (o.title_block) {
    refuse_option("page", "a frame needs a page of its own size, and not one that fits the drawing");
  } else if (!o.scale) {
    refuse_option("page", "one that fits the drawing needs a scale");
  }
}

}  // namespace

void validate(const SheetOptions& o) {
  check_range("pen", o.pen, 0.01, 10);
  check_range("crease_angle", o.crease_angle, 0, std::numbers::pi);
  check_range("shortest_stroke", o.shortest_stroke, 0, 10);
  check_range("margin", o.margin, 0, 1000);
  check_range("scale", o.scale, 1e-12, 1e12);
  check_range("millimetres_per_unit", o.millimetres_per_unit, 1e-12, 1e12);
  check_range("hatch", o.hatch, 0.2, 50);
  check_range("hatch_angle", o.hatch_angle, -100, 100);
  check_range("stipple", o.stipple, 0.2, 10);
  check_range("tessellation_error", o.tessellation_error, 1e-3, 1e3);
  check_named_views(o);
  check_paper(o);
  if (o.dimensions && o.views.empty()) refuse_option("dimensions", "need views");
  check_section_views(o);
}

namespace detail {

void validate_for_view(const SheetOptions& o, const Projection& projection) {
  if (has_named_views(o)) refuse_option("views", "the view is given; draw_sheet() draws named ones");
  if (o.hidden_views) refuse_option("hidden_views", "the view is given; needs named ones");
  if (projection.orthographic) return;
  if (o.scale || o.standard_scale.value_or(false)) refuse_option("scale", "in perspective nothing has a scale");
  if (o.centre_lines.value_or(false)) refuse_option("centre_lines", "perspective has none");
}

double millimetres_per_unit(const SheetOptions& options, const Scene& scene) {
  return options.millimetres_per_unit.value_or(1000 * scene.source.metres_per_unit.value_or(0.001));
}

bool is_in_inches(const SheetOptions& options, const Scene& scene) {
  return options.in_inches.value_or(std::abs(millimetres_per_unit(options, scene) - inch) < 1e-9);
}

LinePens pens_of(const SheetOptions& options) {
  LinePens pens = options.style == DrawingStyle::figure ? figure_pens() : technical_pens();
  if (options.hidden == HiddenLines::thin) pens.hidden = thin_pen();
  if (!options.pen) return pens;
  const double factor = *options.pen / pens.seen.width;
  for (Pen* const pen :
       {&pens.outline, &pens.seen, &pens.crease, &pens.hidden, &pens.hatching, &pens.stippling, &pens.centre}) {
    pen->width *= factor;
    for (double& dash : pen->dashes) dash *= factor;  // standards count dashes in widths
  }
  return pens;
}

}  // namespace detail
}  // namespace frontmost
