// SPDX-License-Identifier: Apache-2.0
// Reasons why triangles are hidden: they face away, lie outside of the view, or behind others.
#include <frontmost/report.h>
#include <frontmost/zbuffer.h>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

struct Facing {
  double cosine = 0;  ///< cosine of the angle between the normal and the direction to the eye
  glm::dvec3 middle{0}, normal{0};
};

Facing facing_of(const Surfaces& surfaces, const View& view, PrimitiveId id) {
  const std::array<glm::vec3, 3> corners = surfaces.corners(id);
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]), cross = glm::cross(b - a, c - a);
  Facing facing;
  facing.middle = (a + b + c) / 3.0;
  const double length = glm::length(cross);
  if (length == 0) return facing;
  facing.normal = cross / length;
  const glm::dvec3 to_eye = view.projection.orthographic ? -view.forward() : view.eye() - facing.middle;
  facing.cosine = glm::dot(facing.normal, to_eye) / glm::length(to_eye);
  return facing;
}

/// The number of pixels that show another triangle.
std::size_t count_changes(const Visible& a, const Visible& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.primitives.size(); ++i) count += a.primitives[i] != b.primitives[i];
  return count;
}

PlainJson places_json(const TrianglePlaces& places, std::size_t hidden) {
  return {{"turned_away", places.faces_away},
          {"behind_eye", places.behind_eye},
          {"outside", places.outside() + places.nearer_than_near + places.beyond_far},
          {"hidden", hidden},
          {"seen", places.in_view - hidden}};
}

/// The centres of triangles without any visible sample, grouped by the first reason that applies.
PlainJson reasons(const Surfaces& surfaces, View view) {
  view.culling = Culling::back;
  const Visible visible = zbuffer(surfaces, view);
  TrianglePlaces sum;
  for (const Explanation& why : explain_all(surfaces, visible, account(surfaces, visible, {1}))) {
    sum.behind_eye += why.triangles.behind_eye, sum.nearer_than_near += why.triangles.nearer_than_near;
    sum.beyond_far += why.triangles.beyond_far, sum.left += why.triangles.outside();
    sum.faces_away += why.triangles.faces_away, sum.in_view += why.triangles.in_view;
  }
  std::vector<bool> is_seen(surfaces.primitive_count());
  std::size_t seen = 0;
  for (const PrimitiveId id : visible.primitives)
    if (id != no_primitive && !is_seen[id]) is_seen[id] = true, ++seen;
  return places_json(sum, sum.in_view - std::min<std::size_t>(seen, sum.in_view));
}

}  // namespace

PlainJson culling_lesson(const PlainJson& question) {
  static Bitmap picture;
  const LessonScene& stage = lesson_scene(question);
  View view = lesson_view(stage, question);
  View all = view;
  all.culling = Culling::none;
  const Visible visible = zbuffer(stage.surfaces, view);
  const Visible without = zbuffer(stage.surfaces, all);
  picture = lesson_picture(stage, visible);
  PlainJson arrows = PlainJson::array();
  std::size_t front = 0, back = 0, edge_on = 0;
  constexpr PrimitiveId most_arrows = 200;
  const double length = 0.12 * double(stage.surfaces.bounds().diagonal());
  for (PrimitiveId id = 0; id < stage.surfaces.primitive_count(); ++id) {
    const Facing facing = facing_of(stage.surfaces, view, id);
    ++(facing.cosine > 0 ? front : facing.cosine < 0 ? back : edge_on);
    if (stage.surfaces.primitive_count() > most_arrows) continue;
    arrows.push_back({{"from", to_json(pixel_of_point(view, facing.middle))},
                      {"to", to_json(pixel_of_point(view, facing.middle + facing.normal * length))},
                      {"cosine", facing.cosine},
                      {"middle", to_json(facing.middle)},
                      {"normal", to_json(facing.normal)}});
  }
  return {{"width", picture.width},
          {"height", picture.height},
          {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
          {"front", front},
          {"back", back},
          {"edge_on", edge_on},
          {"changed", count_changes(visible, without)},
          {"reasons", reasons(stage.surfaces, view)},
          {"arrows", std::move(arrows)}};
}

}  // namespace frontmost::web
