// SPDX-License-Identifier: Apache-2.0
// Answers of the workbench about a view: the surfaces under a pixel, the visibility of each object with reasons, and
// the faces visible from anywhere.
#include <frontmost/report.h>

#include <numeric>

#include "web/camera.h"
#include "web/workbench.h"

namespace frontmost::web {
namespace {

PlainJson hit_json(const Surfaces& surfaces, PrimitiveId id, double depth) {
  const PrimitiveSource source = surfaces.source(id);
  const Scene& scene = surfaces.scene();
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  PlainJson json = {{"object", source.instance},
                    {"name", utf8_text(scene.instances[source.instance].name)},
                    {"triangle", source.triangle},
                    {"primitive", id},
                    {"depth", finite_or_null(depth)}};
  if (material != no_index) json["material"] = utf8_text(scene.materials[material].name);
  return json;
}

PlainJson object_json(const Explanation& why, const ObjectAccount& account, const ObjectNames& names) {
  PlainJson hiders = PlainJson::array();
  for (const HiderShare& hider : why.hiders)
    hiders.push_back({{"object", hider.object}, {"name", names[hider.object]}, {"share", hider.share}});
  return {{"object", why.object},
          {"name", names[why.object]},
          {"reason", name(why.reason)},
          {"sentence", utf8_text(sentence(why, names))},
          {"visible", account.visible.count},
          {"visible_share", account.visible_share()},
          {"hidden_share", account.hidden_share()},
          {"cut_share", account.cut_share()},
          {"distance", finite_or_null(account.distance)},
          {"hidden_by", std::move(hiders)}};
}

/// Directions on a spiral from below to above, as in `frontmost visible --sphere`.
glm::dvec3 direction_around(const glm::dvec3& up, int i, int count) {
  constexpr double golden_angle = 2.3999632297286533;
  const glm::dvec3 side = {up.y, up.z, up.x}, third = glm::cross(up, side);
  const double height = (2.0 * i + 1) / count - 1, around = std::sqrt(1 - height * height);
  return up * -height + (side * std::cos(golden_angle * i) + third * std::sin(golden_angle * i)) * around;
}

}  // namespace

PlainJson Workbench::point(const PlainJson& question) {
  Model& now = model();
  const Visible& visible = seen();
  const int x = question.at("x"), y = question.at("y");
  if (x < 0 || y < 0 || x >= visible.view.width || y >= visible.view.height)
    throw Error(ErrorCode::bad_argument, "point", "outside of the picture");
  PlainJson hits = PlainJson::array();
  const std::size_t i = visible.index(x, y);
  const PrimitiveId first = visible.primitives[i];
  if (first != no_primitive) hits.push_back(hit_json(now.surfaces, first, depth_of_key(visible.view, visible.keys[i])));
  if (question.value("behind", true)) {
    constexpr std::size_t most_hits = 64;
    if (!now.index) now.index.emplace(now.surfaces);
    const SightLine sight = sight_through(visible.view, x, y);
    const Ray ray{glm::vec3(sight.origin), glm::vec3(sight.direction)};
    const double along = glm::dot(glm::dvec3(ray.direction), visible.view.forward());
    for (const RayHit& hit : all_hits(*now.index, ray)) {
      const double depth = hit.t * along;
      const ClipDistances& clip = visible.view.projection.clip;
      if (hit.primitive == first || depth < clip.near || depth > clip.far) continue;
      if (hits.size() < most_hits) hits.push_back(hit_json(now.surfaces, hit.primitive, depth));
    }
  }
  return {{"hits", std::move(hits)}};
}

PlainJson Workbench::report(const PlainJson&) {
  Model& now = model();
  const Visible& visible = seen();
  const Accounting accounts = account(now.surfaces, visible);
  const ObjectNames names(now.scene);
  PlainJson objects = PlainJson::array();
  for (const Explanation& why : explain_all(now.surfaces, visible, accounts))
    objects.push_back(object_json(why, accounts.objects[why.object], names));
  return {{"width", visible.view.width},
          {"height", visible.view.height},
          {"background", accounts.background},
          {"objects", std::move(objects)},
          {"cycles", find_hiding_order(accounts.objects.size(), accounts.hidden_by_front).cycles}};
}

PlainJson Workbench::sphere(const PlainJson& question) {
  Model& now = model();
  const int count = question.value("views", 20), size = question.value("size", 256);
  if (count < 1 || count > 1000) throw Error(ErrorCode::bad_argument, "views", "must be 1 to 1000");
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    FrameOptions options;
    options.forward = direction_around(direction(now.scene.up), i, count);
    options.up = direction(now.scene.up);
    views.push_back(frontmost::frame(now.surfaces, size, size, options));
  }
  const std::vector<SeenFace> faces = faces_ever_seen(now.surfaces, views);
  std::vector<std::uint32_t> seen_of(now.scene.instances.size()), triangles_of;
  for (const Instance& instance : now.scene.instances)
    triangles_of.push_back(std::uint32_t(now.scene.meshes[instance.mesh].triangles.size()));
  for (const SeenFace& face : faces) ++seen_of[now.surfaces.source(face.id).instance];
  const ObjectNames object_names(now.scene);
  PlainJson names = PlainJson::array();
  for (std::uint32_t i = 0; i < now.scene.instances.size(); ++i) names.push_back(utf8_text(object_names[i]));
  return {{"views", count}, {"triangles", now.surfaces.primitive_count()}, {"ever_seen", faces.size()},
          {"names", names}, {"triangles_by_object", triangles_of},         {"seen_by_object", seen_of}};
}

}  // namespace frontmost::web
