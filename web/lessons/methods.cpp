// SPDX-License-Identifier: Apache-2.0
// All methods on one view: time, size of the answer, and number of pixels that differ from the z-buffer's.
#include <frontmost/abuffer.h>
#include <frontmost/lines.h>
#include <frontmost/occlusion.h>
#include <frontmost/painter.h>
#include <frontmost/raycast.h>
#include <frontmost/report.h>
#include <frontmost/zbuffer.h>

#include <algorithm>
#include <chrono>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// The shortest time of three runs, in milliseconds.
template <class Run>
double time_of(const Run& run) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
    least = std::min(least, passed.count());
  }
  return least;
}

std::size_t bytes_of(const Visible& visible) { return 8 * visible.primitives.size(); }

PlainJson differing_from(const Visible& right, const Visible& other) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < right.primitives.size(); ++i) count += right.primitives[i] != other.primitives[i];
  return count;
}

/// The triangles of all objects that are not proved hidden.
std::vector<PrimitiveId> kept_by(const Occlusion& occlusion, std::span<const ObjectSight> sights,
                                 const Surfaces& surfaces) {
  std::vector<PrimitiveId> kept;
  for (std::size_t i = 0; i < occlusion.object_count(); ++i)
    if (sights[i] == ObjectSight::may_be_seen)
      for (const std::uint32_t triangle : occlusion.triangles(i))
        kept.push_back(surfaces.first_primitive(occlusion.object(i).instance) + triangle);
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Draws the kept triangles and restores their original numbers.
Visible drawn_without_rest(const Surfaces& surfaces, const View& view, std::span<const PrimitiveId> kept) {
  const Scene scene = keep_faces(surfaces.scene(), kept);
  Visible visible = zbuffer(Surfaces(scene), view);
  for (PrimitiveId& id : visible.primitives)
    if (id != no_primitive) id = kept[id];
  return visible;
}

/// Clusters of at most 128 triangles that are proved hidden or outside.
PlainJson occlusion_json(const LessonScene& stage, const View& view, const Visible& right) {
  std::optional<Occlusion> occlusion;
  PlainJson answer;
  answer["ready"] = time_of([&] { occlusion.emplace(stage.surfaces, ObjectUnit::clusters); });
  std::span<const ObjectSight> sights;
  answer["milliseconds"] = time_of([&] { sights = occlusion->cull(view); });
  const std::vector<PrimitiveId> kept = kept_by(*occlusion, sights, stage.surfaces);
  answer["culled"] = stage.surfaces.primitive_count() - kept.size();
  answer["differing"] = differing_from(right, drawn_without_rest(stage.surfaces, view, kept));
  return answer;
}

}  // namespace

/// Runs one method: {"scene", "camera" or size, "method"}. The page asks for each separately and can show each result
/// at once.
PlainJson methods_lesson(const PlainJson& question) {
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const std::string method = question.at("method");
  PlainJson answer = {{"method", method}, {"triangles", stage.surfaces.primitive_count()}};
  const Visible right = zbuffer(stage.surfaces, view);
  if (method == "zbuffer") {
    ZBuffer buffer;
    answer["milliseconds"] = time_of([&] { buffer.draw(stage.surfaces, view); });
    answer["bytes"] = bytes_of(right);
    answer["differing"] = 0;
  } else if (method == "raycast") {
    std::optional<RayIndex> index;
    answer["ready"] = time_of([&] { index.emplace(stage.surfaces); });
    RayCaster caster;
    answer["milliseconds"] = time_of([&] { caster.draw(*index, view); });
    answer["bytes"] = bytes_of(right) + index->byte_count();
    answer["differing"] = differing_from(right, caster.take());
  } else if (method == "abuffer") {
    FragmentLists lists;
    answer["milliseconds"] = time_of([&] { lists = abuffer(stage.surfaces, view, {8}); });
    answer["bytes"] = lists.fragments.size() * sizeof(Fragment) + lists.first.size() * 8;
    answer["differing"] = differing_from(right, visible_layers(stage.surfaces, view, 1).front());
  } else if (method == "painter") {
    PaintOrder order;
    answer["milliseconds"] = time_of([&] { order = painter(stage.surfaces, view); });
    answer["bytes"] = order.polygons.size() * sizeof(PaintPolygon) + order.corners.size() * sizeof(PaintCorner);
    answer["differing"] = differing_from(right, paint(stage.surfaces, order));
  } else if (method == "occlusion") {
    answer.update(occlusion_json(stage, view, right));
  } else if (method == "lines") {
    Drawing drawing;
    answer["milliseconds"] = time_of([&] { drawing = draw_lines(stage.surfaces, view); });
    answer["bytes"] = drawing.edges.size() * sizeof(DrawnEdge) + drawing.parts.size() * sizeof(DrawnPart);
  } else {
    throw Error(ErrorCode::bad_argument, "method", "there is no '" + method + "'");
  }
  return answer;
}

}  // namespace frontmost::web
