// SPDX-License-Identifier: Apache-2.0
// From the cameras of a sheet's views to their lines, and their extent on the page.
//
// camera --> surfaces (tessellated again if curved, cut for a section) --> lines --> extent
//
// Curved surfaces are tessellated for each view, as finely as paper shows. If the eye is so near that this would give
// millions of triangles, the tessellation is coarser.
#include <algorithm>

#include "frontmost/view.h"
#include "sheets/page_marks.h"
#include "sheets/planned_view.h"
#include "sheets/sections/sections.h"
#include "view/tessellate/level.h"

namespace frontmost {

std::string_view view_name(NamedView view) {
  constexpr std::string_view names[] = {"front", "back", "left", "right", "top", "bottom", "iso", "three-quarter"};
  return names[int(view)];
}

namespace detail {
namespace {

constexpr glm::ivec2 fine_grid{3840, 2160};  // the shape of render()'s default pictures, for the same camera
constexpr double fine_error = 0.2;           // in pixels of that grid: about 0.01 mm on a sheet of A4
constexpr double coarsest_error = 10;
constexpr double most_fine_triangles = 2e6;  // seconds to draw

/// The finest error that paper shows, or a coarser one if the eye is too near for that. None if even the coarsest error
/// takes too many triangles: then the model's own triangles look better.
std::optional<double> tessellation_error(const SheetOptions& options, const Scene& scene, const View& view) {
  if (options.tessellation_error) return options.tessellation_error;
  for (double error = fine_error; error <= coarsest_error; error *= 2)
    if (tessellated_count(scene, view, error) <= most_fine_triangles) return error;
  return std::nullopt;
}

/// The triangles of `surfaces`, tessellated again for the view if they are curved.
std::shared_ptr<const Surfaces> surfaces_for(const Surfaces& surfaces, const View& view, const SheetOptions& options,
                                             const Execution& execution) {
  std::optional<double> error;
  if (has_curved(surfaces.scene())) error = tessellation_error(options, surfaces.scene(), view);
  if (!error) return {std::shared_ptr<void>(), &surfaces};
  return surfaces_of(std::make_shared<const Scene>(tessellate(surfaces.scene(), view, *error)), execution);
}

/// By default, views at an angle show no hidden lines, since these would obscure the shape.
bool shows_hidden(const SheetOptions& options, NamedView direction) {
  if (options.hidden == HiddenLines::none) return false;
  if (!options.hidden_views) return !is_at_an_angle(direction);
  return std::find(options.hidden_views->begin(), options.hidden_views->end(), direction) !=
         options.hidden_views->end();
}

PlannedView draw_planned(std::shared_ptr<const Surfaces> surfaces, const View& view, const SheetOptions& options,
                         const Execution& execution) {
  PlannedView result;
  result.surfaces = std::move(surfaces);
  LineOptions wanted;
  wanted.crease_angle = options.crease_angle;
  wanted.outlines = options.style == DrawingStyle::figure;
  result.drawing = draw_lines(*result.surfaces, view, wanted, execution);
  return result;
}

/// The near and far planes of the options in place of those that enclose the model.
ClipDistances planes_of(const ClipDistances& fitted, NamedView direction, const SheetOptions& options) {
  const ClipDistances planes{options.near.value_or(fitted.near), options.far.value_or(fitted.far)};
  if (!(planes.near < planes.far) && !(options.near && options.far))
    refuse_option(options.near ? "near" : "far", "leaves nothing of the " + std::string(view_name(direction)) +
                                                     " view, in which the model lies from " +
                                                     number_text(fitted.near, 3) + " to " + number_text(fitted.far, 3));
  return planes;
}

View camera_of(const Surfaces& surfaces, NamedView direction, const SheetOptions& options) {
  View view = frame(surfaces, fine_grid.x, fine_grid.y,
                    {.direction = direction, .orthographic = true, .objects = FramedObjects::all});
  view.projection.clip = planes_of(view.projection.clip, direction, options);
  return view;
}

double millimetres_per_pixel(const View& view, const SheetOptions& options, const Scene& scene) {
  const Projection& p = view.projection;
  return p.orthographic ? (p.right - p.left) / view.width * millimetres_per_unit(options, scene) : 1;
}

PlannedView draw_named(const Surfaces& surfaces, NamedView direction, const SectionView* section,
                       const SheetOptions& options, const Execution& execution) {
  const View view = camera_of(surfaces, direction, options);
  std::shared_ptr<const Surfaces> shown = surfaces_for(surfaces, view, options, execution);
  const CutScene cut = section ? cut_for(*section, *shown, view, execution) : CutScene{shown, nullptr, {}};
  PlannedView result = draw_planned(cut.surfaces, view, options, execution);
  result.direction = direction;
  result.section = cut.section;
  result.plane = cut.plane;
  result.shows_hidden = !section && shows_hidden(options, direction);
  result.millimetres_per_pixel = millimetres_per_pixel(view, options, surfaces.scene());
  return result;
}

/// The pixel that views in line share: the middle of the model.
glm::dvec2 middle_pixel(const View& view, const Surfaces& surfaces) {
  const Box& box = surfaces.bounds();
  const glm::dvec3 low(box.low), high(box.high), middle = box.is_empty() ? glm::dvec3(0) : low + (high - low) * 0.5;
  const glm::dvec3 offset = middle - view.eye();
  const Projection& p = view.projection;
  return {(glm::dot(offset, view.right()) - p.left) / (p.right - p.left) * view.width,
          (p.top - glm::dot(offset, view.up())) / (p.top - p.bottom) * view.height};
}

}  // namespace

std::vector<PlannedView> draw_named_views(const Surfaces& surfaces, const SheetOptions& options,
                                          const Execution& execution) {
  std::vector<PlannedView> views;
  for (const NamedView direction : options.views) {
    PlannedView& view = views.emplace_back(draw_named(surfaces, direction, nullptr, options, execution));
    view.name = view.placed.name = view_name(direction);
  }
  for (std::size_t i = 0; i < options.sections.size(); ++i) {
    const SectionView& section = options.sections[i];
    PlannedView& view = views.emplace_back(draw_named(surfaces, section.direction, &section, options, execution));
    view.letter = section_letters[i];
    view.name = view.placed.name = view.letter + "-" + view.letter;
  }
  return views;
}

PlannedView draw_given_view(const Surfaces& surfaces, const View& view, const SheetOptions& options,
                            const Execution& execution) {
  PlannedView result = draw_planned(surfaces_for(surfaces, view, options, execution), view, options, execution);
  result.shows_hidden = options.hidden != HiddenLines::none;
  result.millimetres_per_pixel = millimetres_per_pixel(view, options, surfaces.scene());
  return result;
}

void find_rounds_of(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution) {
  // Dimensions need rounds, too.
  if (!options.dimensions && !wants_centre_lines(options)) return;
  for (std::size_t i = 0; i < views.size(); ++i) {
    // Named views at an angle show nothing along its axis.
    if (views[i].direction && is_at_an_angle(*views[i].direction)) continue;
    for (std::size_t k = 0; k < i && !views[i].rounds; ++k)
      if (views[k].surfaces == views[i].surfaces) views[i].rounds = views[k].rounds;
    if (!views[i].rounds) views[i].rounds = std::make_shared<const Rounds>(find_rounds(*views[i].surfaces, execution));
  }
}

Cells cells_of(const std::vector<PlannedView>& views, const Surfaces& surfaces, const SheetOptions& options) {
  Cells all;
  for (const PlannedView& view : views) {
    const View& camera = view.drawing.view;
    DrawingBounds box = bounds_of(view.drawing, view.shows_hidden);
    if (options.keeps_picture || box.is_empty()) box = {glm::dvec2(0), glm::dvec2(camera.width, camera.height)};
    ViewCell& cell = all.cells.emplace_back();
    glm::dvec2 anchor = (box.low + box.high) * 0.5;
    if (view.direction) {
      const glm::ivec2 place = cell_of(*view.direction, options.projection);
      cell.column = place.x;
      cell.row = place.y;
      if (!is_at_an_angle(*view.direction)) anchor = middle_pixel(camera, surfaces);
    }
    cell.low = (box.low - anchor) * view.millimetres_per_pixel;
    cell.high = (box.high - anchor) * view.millimetres_per_pixel;
    if (view.rounds && !view.rounds->rounds.empty()) cell.room_before = cell.room_behind = glm::dvec2(centre_overshoot);
    all.anchors.push_back(anchor);
  }
  return all;
}

}  // namespace detail
}  // namespace frontmost
