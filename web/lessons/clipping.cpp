// SPDX-License-Identifier: Apache-2.0
// Clipping: a triangle is cut by the planes of the viewing volume, one after the other, before the division by w.
#include <frontmost/report.h>
#include <frontmost/zbuffer.h>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// A corner in world space and in clip space.
struct ClipCorner {
  glm::dvec3 world{0};
  glm::dvec4 clip{0};
  bool is_new = false;  ///< the corner comes from a cut
};

/// Clip planes, positive inside: near, far, left, right, bottom, top.
constexpr std::array<std::array<double, 4>, 6> kPlanes = {
    {{0, 0, 1, 1}, {0, 0, -1, 1}, {1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 1, 0, 1}, {0, -1, 0, 1}}};

/// Clips a polygon by a plane (I. Sutherland, G. Hodgman. Reentrant Polygon Clipping. 1974.)
std::vector<ClipCorner> clip(const std::vector<ClipCorner>& polygon, const std::array<double, 4>& plane) {
  const glm::dvec4 normal(plane[0], plane[1], plane[2], plane[3]);
  std::vector<ClipCorner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClipCorner& from = polygon[i];
    const ClipCorner& to = polygon[(i + 1) % polygon.size()];
    const double at_from = glm::dot(normal, from.clip), at_to = glm::dot(normal, to.clip);
    if (at_from >= 0) kept.push_back(from);
    if ((at_from >= 0) == (at_to >= 0)) continue;
    const double share = at_from / (at_from - at_to);
    kept.push_back({from.world + (to.world - from.world) * share, from.clip + (to.clip - from.clip) * share, true});
  }
  return kept;
}

/// The position after the division, in pixels. Negative w is allowed and mirrors the position.
glm::dvec2 divided(const View& view, const glm::dvec4& clip) {
  return {(clip.x / clip.w + 1) / 2 * view.width, (1 - clip.y / clip.w) / 2 * view.height};
}

double area_of(const View& view, const std::vector<ClipCorner>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = divided(view, polygon[i].clip), b = divided(view, polygon[(i + 1) % polygon.size()].clip);
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

PlainJson polygon_json(const View& view, const View& beside, const std::vector<ClipCorner>& polygon) {
  PlainJson corners = PlainJson::array();
  for (const ClipCorner& corner : polygon)
    corners.push_back({{"beside", to_json(pixel_of_point(beside, corner.world))},
                       {"screen", to_json(divided(view, corner.clip))},
                       {"clip", to_json(corner.clip)},
                       {"is_new", corner.is_new}});
  return corners;
}

}  // namespace

PlainJson clipping_lesson(const PlainJson& question) {
  static std::vector<std::uint8_t> colors;
  Scene scene;
  Mesh mesh;
  for (const PlainJson& corner : question.at("corners")) mesh.positions.push_back(glm::vec3(vector_of(corner)));
  mesh.triangles = {{0, 1, 2}};
  add(scene, std::move(mesh));
  const Surfaces surfaces(scene);
  View view = make_view(glm::radians(50.0), 400, 300).between(1, 6);
  const View beside = view_of(question.at("beside"), {});
  const glm::dmat4 clip_from_world = clip_from_eye(view.projection) * glm::inverse(view.world_from_eye);
  std::vector<ClipCorner> polygon;
  for (const glm::vec3& corner : surfaces.corners(0))
    polygon.push_back({glm::dvec3(corner), clip_from_world * glm::dvec4(corner, 1), false});
  PlainJson steps = PlainJson::array({polygon_json(view, beside, polygon)});
  for (const auto& plane : kPlanes) {
    polygon = clip(polygon, plane);
    steps.push_back(polygon_json(view, beside, polygon));
  }
  const Visible visible = zbuffer(surfaces, view);
  colors = triangle_colors(visible);
  const VisibleFaces faces = visible_faces(surfaces, view);
  const WorldLine eye_plane = {view.eye() - view.right() * 3.0, view.eye() + view.right() * 3.0};
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(colors.data(), colors.size())},
          {"steps", std::move(steps)},
          {"area", area_of(view, polygon)},
          {"library", faces.faces.empty() ? 0 : faces.faces.front().pixels},
          {"volume", lines_json(beside, sides_of_volume(view))},
          {"eye", to_json(pixel_of_point(beside, view.eye()))},
          {"eye_plane", lines_json(beside, {&eye_plane, 1})}};
}

}  // namespace frontmost::web
