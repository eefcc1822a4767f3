// SPDX-License-Identifier: Apache-2.0
// The painter's lesson: polygons in the painting order of a method, and the wrong pixels.
#include <frontmost/painter.h>
#include <frontmost/zbuffer.h>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

PlainJson steps_json(const PaintSteps& steps) {
  return {{"depths_apart", steps.depths_apart},
          {"boxes_apart", steps.boxes_apart},
          {"behind", steps.behind},
          {"before", steps.before},
          {"projections_apart", steps.projections_apart},
          {"compared", steps.compared},
          {"exchanges", steps.exchanges},
          {"cycles", steps.cycles},
          {"cuts", steps.cuts}};
}

PaintMethod method_of(const std::string& name) {
  constexpr const char* names[] = {"depth_sort", "bsp", "farthest", "centroid"};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (name == names[i]) return PaintMethod(i);
  throw Error(ErrorCode::bad_argument, "method", "there is no '" + name + "'");
}

}  // namespace

PlainJson painter_lesson(const PlainJson& question) {
  static std::vector<std::uint8_t> colors, wrong;
  const LessonScene& stage = lesson_scene(question);
  View view = lesson_view(stage, question);
  PainterOptions options;
  options.method = method_of(question.value("method", "depth_sort"));
  PaintOrder order = painter(stage.surfaces, view, options);
  const std::size_t count = order.polygons.size();
  const std::size_t step = std::min<std::size_t>(question.value("step", count), count);
  const Visible whole = paint(stage.surfaces, order);
  const Visible right = zbuffer(stage.surfaces, view);
  PlainJson polygon = nullptr;
  if (step > 0) {
    const PaintPolygon& last = order.polygons[step - 1];
    polygon = {{"triangle", last.id}, {"corners", PlainJson::array()}};
    double near = order.corners[last.first_corner].at.z, far = near;
    for (std::size_t i = 0; i < last.corner_count; ++i) {
      const PaintCorner& corner = order.corners[last.first_corner + i];
      polygon["corners"].push_back({corner.at.x, corner.at.y, corner.is_cut});
      near = std::min(near, corner.at.z), far = std::max(far, corner.at.z);
    }
    polygon["near"] = near;
    polygon["far"] = far;
  }
  const PlainJson steps = steps_json(order.steps);
  order.polygons.resize(step);
  colors = triangle_colors(paint(stage.surfaces, order));
  wrong.assign(colors.size(), 0);
  std::size_t wrong_count = 0;
  for (std::size_t i = 0; i < right.primitives.size(); ++i) {
    if (whole.primitives[i] == right.primitives[i]) continue;
    ++wrong_count;
    const std::uint8_t mark[4] = {224, 36, 60, 255};
    std::copy(mark, mark + 4, wrong.begin() + std::ptrdiff_t(4 * i));
  }
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(colors.data(), colors.size())},
          {"wrong", place_of(wrong.data(), wrong.size())},
          {"wrong_count", wrong_count},
          {"polygons", count},
          {"triangles", stage.surfaces.primitive_count()},
          {"polygon", std::move(polygon)},
          {"steps", steps}};
}

}  // namespace frontmost::web
