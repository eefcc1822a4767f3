// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: objects from the eye outwards, the cells covered so far, and the objects proved hidden.
#include <frontmost/occlusion.h>
#include <frontmost/zbuffer.h>

#include <algorithm>
#include <map>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

const char* name_of(ObjectSight sight) {
  constexpr const char* names[] = {"outside", "hidden", "may_be_seen"};
  return names[std::size_t(sight)];
}

/// A unit of culling that the sweep visits, with its box.
struct SweptObject {
  std::size_t number = 0;  ///< number in the Occlusion
  Box box;
  double nearest = std::numeric_limits<double>::infinity();  ///< distance of its nearest corner before the eye
};

/// The unit of culling: objects of the scene if there are enough, else connected parts, else clusters of neighbouring
/// triangles.
ObjectUnit unit_of(const Surfaces& surfaces) {
  constexpr std::size_t some = 8;
  for (const ObjectUnit unit : {ObjectUnit::instances, ObjectUnit::parts})
    if (Occlusion(surfaces, unit).object_count() >= some) return unit;
  return ObjectUnit::clusters;
}

std::vector<SweptObject> outwards(const Surfaces& surfaces, const Occlusion& occlusion, const View& view) {
  std::vector<SweptObject> objects;
  for (std::size_t number = 0; number < occlusion.object_count(); ++number) {
    if (occlusion.triangles(number).empty()) continue;
    SweptObject& object = objects.emplace_back();
    object.number = number;
    const PrimitiveId first = surfaces.first_primitive(occlusion.object(number).instance);
    for (const std::uint32_t triangle : occlusion.triangles(number))
      for (const glm::vec3& corner : surfaces.corners(first + triangle)) object.box.include(corner);
    for (const WorldLine& side : sides_of(object.box))
      for (const glm::dvec3& corner : side) object.nearest = std::min(object.nearest, from_eye(view, corner).z);
  }
  std::stable_sort(objects.begin(), objects.end(),
                   [](const SweptObject& a, const SweptObject& b) { return a.nearest < b.nearest; });
  return objects;
}

/// A scene with only the triangles of these objects.
Scene scene_of(const Scene& scene, const Occlusion& occlusion, std::span<const SweptObject> objects) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> kept;
  for (const SweptObject& object : objects) {
    std::vector<std::uint32_t>& triangles = kept[occlusion.object(object.number).instance];
    const std::span<const std::uint32_t> more = occlusion.triangles(object.number);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  Scene some;
  some.materials = scene.materials;
  some.textures = scene.textures;
  for (const auto& [instance, triangles] : kept) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    Mesh part;
    part.positions = mesh.positions;
    for (const std::uint32_t triangle : triangles) {
      part.triangles.push_back(mesh.triangles[triangle]);
      part.material_ids.push_back(mesh.material_of(triangle));
    }
    add(some, std::move(part), scene.instances[instance].world_from_mesh);
  }
  return some;
}

/// For each cell of a picture, whether the scene hides everything behind it. The test point lies beyond all surfaces.
std::string covered_cells(const Scene& scene, ObjectUnit unit, const View& view, int cell) {
  const int across = (view.width + cell - 1) / cell, down = (view.height + cell - 1) / cell;
  std::string cells(std::size_t(across) * std::size_t(down), '0');
  if (scene.instances.empty()) return cells;
  const Surfaces surfaces(scene);
  Occlusion occlusion(surfaces, unit);
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

/// For each object, whether a pixel shows it.
std::vector<bool> seen_objects(const Surfaces& surfaces, const Occlusion& occlusion, const Visible& visible) {
  std::vector<std::size_t> object_of(surfaces.primitive_count());
  for (std::size_t number = 0; number < occlusion.object_count(); ++number)
    for (const std::uint32_t triangle : occlusion.triangles(number))
      object_of[surfaces.first_primitive(occlusion.object(number).instance) + triangle] = number;
  std::vector<bool> is_seen(occlusion.object_count());
  for (const PrimitiveId id : visible.primitives)
    if (id != no_primitive) is_seen[object_of[id]] = true;
  return is_seen;
}

}  // namespace

PlainJson occlusion_lesson(const PlainJson& question) {
  static Bitmap picture;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const int cell = std::clamp(question.value("cell", 8), 1, 64);
  const Visible visible = zbuffer(stage.surfaces, view);
  picture = lesson_picture(stage, visible);
  const ObjectUnit unit = unit_of(stage.surfaces);
  Occlusion occlusion(stage.surfaces, unit);
  const std::span<const ObjectSight> sights = occlusion.cull(view, {cell});
  const std::vector<bool> is_seen = seen_objects(stage.surfaces, occlusion, visible);
  constexpr std::size_t most_objects = 300;
  std::vector<SweptObject> order = outwards(stage.surfaces, occlusion, view);
  order.resize(std::min(order.size(), most_objects));
  const std::size_t step = std::min<std::size_t>(question.value("step", order.size()), order.size());
  PlainJson objects = PlainJson::array();
  for (const SweptObject& object : order)
    objects.push_back({{"object", object.number},
                       {"sight", name_of(sights[object.number])},
                       {"seen", bool(is_seen[object.number])},
                       {"low", to_json(object.box.low)},
                       {"high", to_json(object.box.high)}});
  const Scene visited = scene_of(stage.scene, occlusion, std::span(order).first(step));
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
                      {"cell", cell},
                      {"across", (view.width + cell - 1) / cell},
                      {"cells", covered_cells(visited, unit, view, cell)},
                      {"object_count", occlusion.object_count()},
                      {"objects", std::move(objects)}};
  if (step > 0) answer["lines"] = lines_json(view, sides_of(order[step - 1].box));
  return answer;
}

}  // namespace frontmost::web
