// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: objects from the eye outwards, the cells that those so far cover, and what they prove hidden.
#include <frontmost/occlusion.h>
#include <frontmost/zbuffer.h>

#include <algorithm>
#include <numeric>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

const char* name_of(ObjectSight sight) {
  constexpr const char* names[] = {"outside", "hidden", "may_be_seen"};
  return names[std::size_t(sight)];
}

/// Instances by how near the nearest corner of their boxes is.
std::vector<std::uint32_t> outwards(const Surfaces& surfaces, const View& view) {
  std::vector<std::uint32_t> order(surfaces.scene().instances.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<double> nearest;
  for (const std::uint32_t instance : order) {
    double least = std::numeric_limits<double>::infinity();
    for (const WorldLine& side : sides_of(surfaces.bounds(instance)))
      for (const glm::dvec3& corner : side) least = std::min(least, from_eye(view, corner).z);
    nearest.push_back(least);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return nearest[a] < nearest[b]; });
  return order;
}

/// For every cell of a picture whether the given objects alone hide all that lies behind them there: asked of a point
/// beyond everything.
std::string covered_cells(const Scene& scene, std::span<const std::uint32_t> instances, const View& view, int cell) {
  const int across = (view.width + cell - 1) / cell, down = (view.height + cell - 1) / cell;
  std::string cells(std::size_t(across) * std::size_t(down), '0');
  if (instances.empty()) return cells;
  Scene some;
  some.meshes = scene.meshes;
  some.materials = scene.materials;
  for (const std::uint32_t instance : instances) some.instances.push_back(scene.instances[instance]);
  const Surfaces surfaces(some);
  Occlusion occlusion(surfaces);
  (void)occlusion.cull(view, {cell});
  const double far = view.projection.clip.far * 0.9999;
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      const SightLine sight = sight_through(view, std::min(x * cell + cell / 2, view.width - 1),
                                            std::min(y * cell + cell / 2, view.height - 1));
      const glm::vec3 beyond(sight.origin + sight.direction * far);
      if (occlusion.sight_of({beyond, beyond}) == ObjectSight::hidden)
        cells[std::size_t(y) * std::size_t(across) + std::size_t(x)] = '1';
    }
  return cells;
}

}  // namespace

PlainJson occlusion_lesson(const PlainJson& question) {
  static Bitmap picture;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const int cell = std::clamp(question.value("cell", 8), 1, 64);
  const Visible visible = zbuffer(stage.surfaces, view);
  picture = lesson_picture(stage, visible);
  Occlusion occlusion(stage.surfaces);
  const std::span<const ObjectSight> sights = occlusion.cull(view, {cell});
  std::vector<bool> is_seen(stage.scene.instances.size());
  for (const PrimitiveId id : visible.primitives)
    if (id != no_primitive) is_seen[stage.surfaces.source(id).instance] = true;
  const std::vector<std::uint32_t> order = outwards(stage.surfaces, view);
  const std::size_t step = std::min<std::size_t>(question.value("step", order.size()), order.size());
  PlainJson objects = PlainJson::array();
  for (const std::uint32_t instance : order) {
    const Box& box = stage.surfaces.bounds(instance);
    objects.push_back({{"object", instance},
                       {"sight", name_of(sights[instance])},
                       {"seen", bool(is_seen[instance])},
                       {"low", to_json(box.low)},
                       {"high", to_json(box.high)}});
  }
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
                      {"cell", cell},
                      {"across", (view.width + cell - 1) / cell},
                      {"cells", covered_cells(stage.scene, std::span(order).first(step), view, cell)},
                      {"objects", std::move(objects)}};
  if (step > 0) answer["lines"] = lines_json(view, sides_of(stage.surfaces.bounds(order[step - 1])));
  return answer;
}

}  // namespace frontmost::web
